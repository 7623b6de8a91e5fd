// What a simulation yields, as plain values: everything that SilvaVis, exports and quick looks need, and nothing else.
//
// Promise: none of the structs alone; validity.h says what must hold, and only what is valid is written or read.
// Source: Silva 2013, section 4.5; the file is described byte for byte in docs/ecosystem-file.md.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "silvasim/base/geometry.h"
#include "silvasim/tiles/tile_set.h"

namespace silvasim::ecosystem {

// Index into Layer::species of the plant that stands on a site, or `no_plant`.
using PlantId = std::uint16_t;
inline constexpr PlantId no_plant = 0xFFFF;

struct Species {
  std::string name;                 // scientific: "Picea abies"; unique in its layer
  std::string common_name;          // "Norway spruce"; may be empty
  std::uint32_t colour = 0x808080;  // 0xRRGGBB
  std::string model;                // path of the plant model as the user wrote it; may be empty
  float model_radius_m = 1;         // crown radius of the model at scale 1
  float height_m = 1;               // height of the model at scale 1
  float least_scale = 0;            // a plant's scale is its site's radius / model_radius_m, within [least, most]
  float most_scale = 0;

  friend bool operator==(const Species&, const Species&) = default;
};

// How well the place suits each species, wherever its plants stand: for maps, on square cells over the extent.
struct SuitabilityMap {
  static constexpr std::uint8_t no_site = 255;

  int columns = 0;  // 0 x 0: not asked for
  int rows = 0;     // row 0 northernmost
  double west = 0;
  double north = 0;
  double cell_m = 1;
  // Species by species, each row by row: the mean probability of the cell's sites, before neighbours and corners, times
  // 254 and rounded; no_site where the cell has none.
  std::vector<std::uint8_t> shares;

  bool empty() const { return shares.empty(); }
  const std::uint8_t* of(std::size_t species) const {
    return shares.data() + species * static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }

  friend bool operator==(const SuitabilityMap&, const SuitabilityMap&) = default;
};

// One vegetation layer (trees, shrubs, herbs): its own tiles, tiling and species.
struct Layer {
  std::string name;
  tiles::TileSet tile_set;
  tiles::Tiling tiling;
  base::Point north_west;  // scene point of the tiling's north-west corner
  std::vector<Species> species;

  // Per (tile position, site id): position by position in the tiling's order, sites in the tile's order.
  std::vector<PlantId> plants;
  // Growth probability of the standing plant, quantised to 1/65535, in the same order; empty unless asked for.
  std::vector<std::uint16_t> probabilities;
  SuitabilityMap suitability;  // empty unless asked for

  friend bool operator==(const Layer&, const Layer&) = default;
};

// The ground's height on a regular grid, for placing plants on it. Values at cell centres; NaN is no data.
// Two terrains are equal when their heights have the same bits, so that one with NaN equals itself.
struct Terrain {
  int columns = 0;
  int rows = 0;  // row 0 northernmost
  double west = 0;
  double north = 0;
  double cell_width_m = 1;
  double cell_height_m = 1;
  std::vector<float> heights_m;

  friend bool operator==(const Terrain& a, const Terrain& b);
};

struct Ecosystem {
  std::string name;
  std::string crs_wkt;        // empty: local metres
  base::Box extent;           // the planted box in the scene's frame, metres
  std::vector<Layer> layers;  // one at least
  Terrain terrain;            // 0 x 0: flat land at height 0
  // One JSON object: seed, version, configuration files with their text and SHA-256, fields with their SHA-256,
  // settings. Holds no time of day and no path of the machine beyond what the user wrote.
  std::string provenance_json = "{}";

  friend bool operator==(const Ecosystem&, const Ecosystem&) = default;
};

// First index in Layer::plants of each tile position, and the total as the last entry.
std::vector<std::uint64_t> site_offsets(const tiles::TileSet& set, const tiles::Tiling& tiling);

// How many plants of each species stand, in the species' order. Works in parallel.
std::vector<std::uint64_t> plants_by_species(const Layer& layer);

// Scene point of a tile position's south-west corner.
base::Point tile_origin(const Layer& layer, int column, int row);

struct Plant {
  base::Point at;      // scene point of the stem
  float radius_m = 0;  // crown radius: the site's
  PlantId species = no_plant;
  int column = 0, row = 0;  // tile position
  std::uint32_t site = 0;   // site id in the tile
  float probability = 1;    // 1 where the ecosystem holds none
};

// Calls visit(Plant) for every standing plant of rows [first_row, last_row), in file order.
template <typename Visit>
void for_each_plant(const Layer& layer, const std::vector<std::uint64_t>& offsets, int first_row, int last_row,
                    Visit&& visit) {
  for (int row = first_row; row < last_row; ++row) {
    for (int column = 0; column < layer.tiling.columns; ++column) {
      const std::size_t position = layer.tiling.position(column, row);
      const auto& sites = layer.tile_set.tiles[layer.tiling.tiles[position]].sites;
      const base::Point origin = tile_origin(layer, column, row);
      for (std::size_t s = 0; s < sites.size(); ++s) {
        const std::size_t i = offsets[position] + s;
        if (layer.plants[i] == no_plant) continue;
        Plant plant;
        plant.at = {origin.x + static_cast<double>(sites[s].x_m), origin.y + static_cast<double>(sites[s].y_m)};
        plant.radius_m = sites[s].radius_m;
        plant.species = layer.plants[i];
        plant.column = column;
        plant.row = row;
        plant.site = static_cast<std::uint32_t>(s);
        if (!layer.probabilities.empty()) plant.probability = static_cast<float>(layer.probabilities[i]) / 65535.0f;
        visit(plant);
      }
    }
  }
}

// Bilinear height of the ground; 0 where there is no terrain or no data.
double height_at(const Terrain& terrain, base::Point point);

}  // namespace silvasim::ecosystem
