// Random ecosystems that are valid, for tests that hold for all of them.
#pragma once

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "silvasim/ecosystem/ecosystem.h"

namespace silvasim::ecosystem {

using Random = std::mt19937_64;

inline std::uint64_t below(Random& random, std::uint64_t bound) { return random() % bound; }
inline double share(Random& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

inline std::string random_text(Random& random) {
  static const char* const pieces[] = {"Picea", " ", "ä", "\"", "\\", "\n", "樹", "🌲", "0", "/"};
  std::string text;
  for (std::uint64_t i = below(random, 8); i > 0; --i) text += pieces[below(random, std::size(pieces))];
  return text;
}

inline tiles::TileSet random_tile_set(Random& random, std::size_t most_sites) {
  tiles::TileSet set;
  set.colours = static_cast<int>(1 + below(random, 4));
  set.variants = static_cast<int>(1 + below(random, 3));
  set.side_m = 1 + 300 * share(random);
  set.most_radius_m = set.side_m / 9;
  const auto colour = [&] { return static_cast<std::uint8_t>(below(random, static_cast<std::uint64_t>(set.colours))); };
  for (int i = 0; i < set.colours * set.colours * set.variants; ++i) {
    tiles::Tile tile;
    tile.colours.north = static_cast<std::uint8_t>(i / set.variants / set.colours);
    tile.colours.west = static_cast<std::uint8_t>(i / set.variants % set.colours);
    tile.colours.east = colour();
    tile.colours.south = colour();
    for (std::uint64_t s = below(random, most_sites + 1); s > 0; --s) {
      const auto place = [&] { return static_cast<float>(0.999 * set.side_m * share(random)); };
      tile.sites.push_back(
          {place(), place(), static_cast<float>(0.999 * set.most_radius_m * (0.01 + 0.99 * share(random)))});
    }
    set.tiles.push_back(tile);
  }
  return set;
}

inline tiles::Tiling random_tiling(Random& random, const tiles::TileSet& set, int columns, int rows) {
  tiles::Tiling tiling{columns, rows, {}};
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const auto free = [&] { return below(random, static_cast<std::uint64_t>(set.colours)); };
      const std::uint64_t north = row > 0 ? set.tiles[tiling.at(column, row - 1)].colours.south : free();
      const std::uint64_t west = column > 0 ? set.tiles[tiling.at(column - 1, row)].colours.east : free();
      const auto variants = static_cast<std::uint64_t>(set.variants);
      tiling.tiles.push_back(static_cast<std::uint16_t>(
          (north * static_cast<std::uint64_t>(set.colours) + west) * variants + below(random, variants)));
    }
  }
  return tiling;
}

struct RandomLayerOptions {
  int columns = 1, rows = 1;
  std::size_t species = 3;
  std::size_t most_sites = 12;  // a tile
  bool probabilities = false;   // and the suitability map
};

inline Layer random_layer(Random& random, const RandomLayerOptions& options) {
  Layer layer;
  layer.tile_set = random_tile_set(random, options.most_sites);
  layer.tiling = random_tiling(random, layer.tile_set, options.columns, options.rows);
  layer.north_west = {1e6 * (share(random) - 0.5), 1e7 * share(random)};
  for (std::size_t i = 0; i < options.species; ++i) {
    Species species;
    species.name = random_text(random) + std::to_string(i);
    species.common_name = random_text(random);
    species.model = random_text(random);
    species.colour = static_cast<std::uint32_t>(below(random, 1 << 24));
    species.model_radius_m = static_cast<float>(0.1 + share(random));
    species.height_m = static_cast<float>(50 * share(random));
    species.least_scale = static_cast<float>(share(random));
    species.most_scale = species.least_scale + static_cast<float>(share(random));
    layer.species.push_back(species);
  }
  const std::uint64_t sites = site_offsets(layer.tile_set, layer.tiling).back();
  for (std::uint64_t i = 0; i < sites; ++i) {
    const bool bare = options.species == 0 || below(random, 4) == 0;
    layer.plants.push_back(bare ? no_plant : static_cast<PlantId>(below(random, options.species)));
    if (options.probabilities) layer.probabilities.push_back(static_cast<std::uint16_t>(random()));
  }
  if (options.probabilities && options.species > 0) {
    SuitabilityMap& map = layer.suitability;
    map.columns = static_cast<int>(1 + below(random, 20));
    map.rows = static_cast<int>(1 + below(random, 20));
    map.west = 1e6 * share(random);
    map.north = -1e6 * share(random);
    map.cell_m = 0.1 + 30 * share(random);
    map.shares.resize(options.species * static_cast<std::size_t>(map.columns * map.rows));
    for (std::uint8_t& value : map.shares) value = static_cast<std::uint8_t>(random());
  }
  return layer;
}

inline Terrain random_terrain(Random& random, int columns, int rows) {
  Terrain terrain;
  terrain.columns = columns;
  terrain.rows = rows;
  terrain.west = 1e6 * share(random);
  terrain.north = -1e6 * share(random);
  terrain.cell_width_m = 0.1 + 30 * share(random);
  terrain.cell_height_m = 0.1 + 30 * share(random);
  for (int i = 0; i < columns * rows; ++i) {
    float height = static_cast<float>(4000 * std::sin(0.01 * i) * share(random));
    switch (below(random, 12)) {
      case 0:
        height = std::numeric_limits<float>::quiet_NaN();
        break;
      // NaN with other bits, minus zero, the largest: whatever is not infinite must come back bit by bit.
      case 1:
        height = std::bit_cast<float>(0xFFC12345u);
        break;
      case 2:
        height = -0.0f;
        break;
      case 3:
        height = -std::numeric_limits<float>::max();
        break;
      default:
        break;
    }
    terrain.heights_m.push_back(height);
  }
  return terrain;
}

inline Ecosystem random_ecosystem(Random& random) {
  Ecosystem ecosystem;
  ecosystem.name = random_text(random);
  ecosystem.crs_wkt = random_text(random);
  ecosystem.extent = {-100 * share(random), -1e6 * share(random), 1 + share(random), 5e6 * share(random) + 1};
  ecosystem.provenance_json = "{\"seed\": " + std::to_string(random()) + ", \"files\": [\"ä\", null]}";
  if (below(random, 3) > 0) {
    ecosystem.terrain =
        random_terrain(random, static_cast<int>(1 + below(random, 30)), static_cast<int>(1 + below(random, 30)));
  }
  for (std::uint64_t i = 1 + below(random, 3); i > 0; --i) {
    static const std::size_t species[] = {0, 1, 2, 9, 254, 255, 256, 700};
    ecosystem.layers.push_back(random_layer(random, {.columns = static_cast<int>(1 + below(random, 9)),
                                                     .rows = static_cast<int>(1 + below(random, 9)),
                                                     .species = species[below(random, std::size(species))],
                                                     .most_sites = below(random, 20),
                                                     .probabilities = below(random, 2) == 0}));
    ecosystem.layers.back().name = "layer " + std::to_string(i) + random_text(random);
  }
  return ecosystem;
}

// Small enough to try every bit, yet with every type of chunk.
inline Ecosystem small_ecosystem() {
  Random random(7);
  Ecosystem ecosystem;
  ecosystem.name = "small";
  ecosystem.crs_wkt = "LOCAL";
  ecosystem.extent = {0, 0, 300, 200};
  ecosystem.provenance_json = R"({"seed":7})";
  ecosystem.terrain = random_terrain(random, 3, 2);
  Layer layer = random_layer(random, {.columns = 3, .rows = 2, .species = 2, .most_sites = 4, .probabilities = true});
  layer.name = "trees";
  layer.tile_set.tiles[0].sites.push_back({0.5f, 0.25f, 0.125f});  // one site at least
  layer.plants.assign(site_offsets(layer.tile_set, layer.tiling).back(), no_plant);
  for (std::size_t i = 0; i < layer.plants.size(); ++i)
    layer.plants[i] = i % 3 == 2 ? no_plant : static_cast<PlantId>(i % 3);
  layer.probabilities.assign(layer.plants.size(), 40000);
  ecosystem.layers.push_back(layer);
  return ecosystem;
}

}  // namespace silvasim::ecosystem
