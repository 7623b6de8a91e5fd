#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "silvasim/base/error.h"
#include "silvasim/base/file.h"
#include "silvasim/export/formats.h"
#include "silvasim/fields/feature_writer.h"

namespace silvasim::exports {

namespace {

// The share of each of the grid's cells: of the map's cell around its centre, which may be larger than it.
std::vector<float> band_values(const ecosystem::SuitabilityMap& map, std::size_t species, const fields::Grid& grid) {
  const std::uint8_t* const shares = map.of(species);
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows));
  for (int row = 0; row < grid.rows; ++row) {
    const double v = (map.north - (grid.north - (row + 0.5) * grid.cell_height)) / map.cell_m;
    for (int column = 0; column < grid.columns; ++column) {
      const double u = (grid.west + (column + 0.5) * grid.cell_width - map.west) / map.cell_m;
      float value = std::numeric_limits<float>::quiet_NaN();
      if (u >= 0 && v >= 0 && u < map.columns && v < map.rows) {
        const std::uint8_t share =
            shares[static_cast<std::size_t>(v) * static_cast<std::size_t>(map.columns) + static_cast<std::size_t>(u)];
        if (share != ecosystem::SuitabilityMap::no_site) value = static_cast<float>(share) / 254.0f;
      }
      values.push_back(value);
    }
  }
  return values;
}

}  // namespace

void write_tif(const ecosystem::Ecosystem& ecosystem, const std::filesystem::path& path,
               const base::Progress& progress) {
  base::report(progress, "write", 0);
  // The layer of the smallest cells gives the grid.
  const ecosystem::SuitabilityMap* finest = nullptr;
  for (const ecosystem::Layer& layer : ecosystem.layers) {
    if (layer.species.empty()) continue;
    if (layer.suitability.empty()) {
      throw base::ConfigError({"--to"}, fmt::format("the ecosystem holds no suitability map for its layer \"{}\"; "
                                                    "simulate it again with: silvasim run ... --probabilities",
                                                    layer.name));
    }
    if (!finest || layer.suitability.cell_m < finest->cell_m) finest = &layer.suitability;
  }
  if (!finest) throw base::ConfigError({"--to"}, "the ecosystem has no species, so there is nothing to map");
  fields::Grid grid;
  grid.columns = finest->columns;
  grid.rows = finest->rows;
  grid.west = finest->west;
  grid.north = finest->north;
  grid.cell_width = grid.cell_height = finest->cell_m;
  grid.no_data = std::numeric_limits<double>::quiet_NaN();
  grid.crs_wkt = ecosystem.crs_wkt;

  std::vector<std::vector<float>> values;
  std::vector<std::string> names;
  for (const ecosystem::Layer& layer : ecosystem.layers) {
    for (std::size_t s = 0; s < layer.species.size(); ++s) {
      values.push_back(band_values(layer.suitability, s, grid));
      names.push_back(ecosystem.layers.size() == 1 ? layer.species[s].name : layer.name + ": " + layer.species[s].name);
    }
  }
  std::vector<fields::Band> bands;
  for (std::size_t b = 0; b < values.size(); ++b) bands.push_back({std::span<const float>(values[b]), names[b]});
  base::NewFile file(path);
  fields::write_geotiff(file.path(), grid, bands);
  file.commit();
}

}  // namespace silvasim::exports
