// Which part of an ecosystem a picture shows, which of its species, and how many plants of each stand there.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "silvasim/base/geometry.h"
#include "silvasim/ecosystem/ecosystem.h"
#include "silvasim/export/picture.h"

namespace silvasim::exports {

// A box of the scene on a grid of pixels; pixel (0, 0) is the north-west corner.
struct View {
  base::Box box;
  int width_px = 1;
  int height_px = 1;

  double px_per_m() const { return width_px / box.width(); }
  double x_px(double x) const { return (x - box.west) * (width_px / box.width()); }
  double y_px(double y) const { return (box.north - y) * (height_px / box.height()); }
  double x_m(double px) const { return box.west + px * (box.width() / width_px); }
  double y_m(double px) const { return box.north - px * (box.height() / height_px); }
};

struct SpeciesCount {
  bool shown = true;
  std::uint64_t plants = 0;     // standing in the box
  double crown_area_m2 = 0;     // of those
  double mean_probability = 0;  // of those; 0 where there is none
  double mean_suitability = 0;  // of the place in the box; only on maps of it
};

struct Census {
  std::vector<std::vector<SpeciesCount>> layers;    // a layer, a species
  std::vector<std::vector<std::uint64_t>> offsets;  // a layer: ecosystem::site_offsets
  std::uint64_t plants = 0;                         // of the shown species in the box
  double mean_radius_m = 0;                         // of those
};

// The box to show: the option's, or the ecosystem's extent. Errors: base::ConfigError where there is no land in it.
base::Box box_of(const ecosystem::Ecosystem& ecosystem, const PreviewOptions& options);

// Errors: base::ConfigError for a species that the ecosystem has not, and for probabilities or maps that it does not hold.
Census take_census(const ecosystem::Ecosystem& ecosystem, const PreviewOptions& options, const base::Box& box);

// Calls visit(ecosystem::Plant) in file order for the standing plants whose tiles touch `box`; some lie outside of it.
template <typename Visit>
void for_each_plant_near(const ecosystem::Layer& layer, const std::vector<std::uint64_t>& offsets, const base::Box& box,
                         Visit&& visit) {
  const double side = layer.tile_set.side_m;
  const auto tile = [&](double metres, int count) {
    return static_cast<int>(std::clamp(std::floor(metres / side), -1.0, static_cast<double>(count)));
  };
  const int first_column = std::max(0, tile(box.west - layer.north_west.x, layer.tiling.columns));
  const int last_column = std::min(layer.tiling.columns - 1, tile(box.east - layer.north_west.x, layer.tiling.columns));
  const int first_row = std::max(0, tile(layer.north_west.y - box.north, layer.tiling.rows) - 1);
  const int last_row = std::min(layer.tiling.rows - 1, tile(layer.north_west.y - box.south, layer.tiling.rows));
  for (int row = first_row; row <= last_row; ++row) {
    for (int column = first_column; column <= last_column; ++column) {
      const std::size_t position = layer.tiling.position(column, row);
      const auto& sites = layer.tile_set.tiles[layer.tiling.tiles[position]].sites;
      const base::Point origin = ecosystem::tile_origin(layer, column, row);
      const ecosystem::PlantId* plants = layer.plants.data() + offsets[position];
      const std::uint16_t* probabilities =
          layer.probabilities.empty() ? nullptr : layer.probabilities.data() + offsets[position];
      for (std::size_t s = 0; s < sites.size(); ++s) {
        if (plants[s] == ecosystem::no_plant) continue;
        ecosystem::Plant plant;
        plant.at = {origin.x + static_cast<double>(sites[s].x_m), origin.y + static_cast<double>(sites[s].y_m)};
        plant.radius_m = sites[s].radius_m;
        plant.species = plants[s];
        plant.column = column;
        plant.row = row;
        plant.site = static_cast<std::uint32_t>(s);
        if (probabilities) plant.probability = static_cast<float>(probabilities[s]) / 65535.0f;
        visit(plant);
      }
    }
  }
}

}  // namespace silvasim::exports
