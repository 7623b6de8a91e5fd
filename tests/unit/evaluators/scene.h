// Scenarios from XML text, with data fields from functions instead of files.
#pragma once

#include <functional>
#include <string>

#include "silvasim/config/load.h"
#include "silvasim/ecosystem/ecosystem.h"
#include "silvasim/evaluators/suitability.h"
#include "silvasim/tiles/fill.h"
#include "silvasim/tiles/tile_land.h"
#include "tests/unit/config/files.h"

namespace silvasim::evaluators {

// A raster of 1 m cells whose cell centres hold f(x, y); NaN is no data.
inline fields::Raster raster(int columns, int rows, const std::function<double(double, double)>& f, double cell = 1) {
  fields::Raster r;
  r.columns = columns;
  r.rows = rows;
  r.west = 0;
  r.north = rows * cell;
  r.cell_width = r.cell_height = cell;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i)
      r.values.push_back(static_cast<float>(f((i + 0.5) * cell, (rows - j - 0.5) * cell)));
  }
  return r;
}

// Everything a network needs, held together.
struct Scene {
  config::Scenario scenario;
  fields::FieldSet fields;
  tiles::TileSet tile_set;
  tiles::Tiling tiling;
  std::vector<std::uint64_t> offsets;

  Ground ground() const {
    return {tile_set, tiling, {fields.frame.extent.west, fields.frame.extent.north}, offsets, fields};
  }
};

using FieldFunctions = std::vector<std::function<double(double, double)>>;

// `inside`: what stands in <ecosystem> after the data fields a, b, c, ... which hold the functions over side x side metres.
// `class` fields are declared by the caller's attributes, one string a field ("kind=\"class\"").
inline Scene make_scene(const std::string& inside, const std::string& plants, const FieldFunctions& functions,
                        double side = 400, const std::vector<std::string>& attributes = {}) {
  config::Files files;
  std::string xml = "<ecosystem seed=\"3\">";
  for (std::size_t k = 0; k < functions.size(); ++k) {
    xml += "<datafield name=\"" + std::string(1, static_cast<char>('a' + k)) + "\" " +
           (k < attributes.size() ? attributes[k] : "") + ">water.png</datafield>";
  }
  files.add("ecosystem.xml", xml + inside + "</ecosystem>").add("plants.xml", "<plants>" + plants + "</plants>");
  Scene scene{files.load(), {}, {}, {}, {}};
  scene.fields.frame.extent = {0, 0, side, side};
  const double cell = side / 100;
  for (std::size_t k = 0; k < functions.size(); ++k) {
    fields::Field field;
    const config::FieldSettings& settings = scene.scenario.fields[k];
    field.name = settings.name;
    field.kind = settings.kind;
    field.no_data = settings.no_data;
    field.no_data_fill = static_cast<float>(settings.no_data_fill);
    field.raster = raster(100, 100, functions[k], cell);
    scene.fields.fields.push_back(std::move(field));
  }
  const config::TileSettings& tiles = scene.scenario.layers[0].tiles;
  scene.tile_set = tiles::fill_tiles(tiles, scene.scenario.seed);
  const int across = static_cast<int>(side / tiles.side_m + 0.999);
  scene.tiling = tiles::tile_land(scene.tile_set, across, across, scene.scenario.seed);
  scene.offsets = ecosystem::site_offsets(scene.tile_set, scene.tiling);
  return scene;
}

}  // namespace silvasim::evaluators
