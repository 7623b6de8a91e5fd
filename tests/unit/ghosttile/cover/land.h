// Small random lands with trees and shrubs, and slow truths about them.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "ghosttile/cover/fillers.h"
#include "silvasim/tiles/tile_land.h"

namespace ghosttile::cover::test {

using Random = std::mt19937_64;

inline double between(Random& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
}

inline silvasim::ecosystem::Layer random_layer(Random& random, const std::string& name, double side, int columns,
                                               int rows, int sites, double most_radius,
                                               std::vector<std::string> species) {
  silvasim::ecosystem::Layer layer;
  layer.name = name;
  layer.tile_set.side_m = side;
  layer.tile_set.most_radius_m = most_radius;
  layer.tile_set.colours = 2;
  layer.tile_set.variants = 2;
  for (std::uint8_t i = 0; i < 8; ++i) {
    silvasim::tiles::Tile tile;
    tile.colours = {static_cast<std::uint8_t>(i / 4), static_cast<std::uint8_t>(random() & 1),
                    static_cast<std::uint8_t>(random() & 1), static_cast<std::uint8_t>(i / 2 % 2)};
    // Not all tiles are equally full, and one has none.
    for (int s = i == 3 ? 0 : sites / 2 + static_cast<int>(random() % static_cast<std::uint64_t>(sites)); s > 0; --s) {
      tile.sites.push_back({static_cast<float>(between(random, 0, 0.9999 * side)),
                            static_cast<float>(between(random, 0, 0.9999 * side)),
                            static_cast<float>(between(random, 0.2, 1) * most_radius)});
    }
    layer.tile_set.tiles.push_back(tile);
  }
  layer.tiling = silvasim::tiles::tile_land(layer.tile_set, columns, rows, random());
  for (std::string& one : species) {
    silvasim::ecosystem::Species entry;
    entry.name = std::move(one);
    entry.model_radius_m = 3;
    entry.height_m = static_cast<float>(between(random, 4, 9)) * entry.model_radius_m;
    entry.most_scale = 10;
    layer.species.push_back(entry);
  }
  layer.plants.resize(silvasim::ecosystem::site_offsets(layer.tile_set, layer.tiling).back());
  for (auto& plant : layer.plants) {
    const std::uint64_t draw = random() % (layer.species.size() + 1);
    plant =
        draw == layer.species.size() ? silvasim::ecosystem::no_plant : static_cast<silvasim::ecosystem::PlantId>(draw);
  }
  return layer;
}

// About 150 x 120 m, far from the origin and across whole numbers of nothing.
inline std::shared_ptr<Ecosystem> random_ecosystem(Random& random) {
  auto ecosystem = std::make_shared<Ecosystem>();
  ecosystem->name = "test";
  ecosystem->layers.push_back(random_layer(random, "trees", 30, 5, 4, 14, 4,
                                           {"Fagus sylvatica", "Quercus robur", "Quercus petraea", "Picea abies"}));
  ecosystem->layers.push_back(
      random_layer(random, "shrubs", 20, 7, 6, 8, 1.5, {"Corylus avellana", "Ilex aquifolium"}));
  const double west = std::floor(between(random, -600000, 600000)) + 0.3,
               north = std::floor(between(random, -1, 1) * 6e6) + 0.7;
  ecosystem->layers[0].north_west = {west, north};
  ecosystem->layers[1].north_west = {west + 3.2, north - 2.9};
  ecosystem->extent = {west, north - 120, west + 150, north};
  auto& terrain = ecosystem->terrain;
  terrain.columns = 17;
  terrain.rows = 14;
  terrain.west = west - 5;
  terrain.north = north + 5;
  terrain.cell_width_m = 10;
  terrain.cell_height_m = 10;
  for (int i = 0; i < terrain.columns * terrain.rows; ++i)
    terrain.heights_m.push_back(static_cast<float>(between(random, 300, 330)));
  return ecosystem;
}

// Every standing plant, read the ecosystem's own way.
inline std::vector<Stem> all_stems(const Plants& plants) {
  std::vector<Stem> stems;
  std::uint32_t first = 0;
  for (const auto& layer : plants.ecosystem().layers) {
    const auto offsets = silvasim::ecosystem::site_offsets(layer.tile_set, layer.tiling);
    silvasim::ecosystem::for_each_plant(
        layer, offsets, 0, layer.tiling.rows, [&](const silvasim::ecosystem::Plant& plant) {
          stems.push_back({plant.at.x, plant.at.y, plant.radius_m, first + plant.species});
        });
    first += static_cast<std::uint32_t>(layer.species.size());
  }
  return stems;
}

inline Chosen choose(const std::shared_ptr<const Plants>& plants,
                     const std::function<bool(const PlantSpecies&)>& wanted) {
  std::vector<bool> species;
  for (const PlantSpecies& one : plants->species()) species.push_back(wanted(one));
  return {plants, plants->select(species)};
}
inline Chosen choose_all(const std::shared_ptr<const Plants>& plants) {
  return choose(plants, [](const PlantSpecies&) { return true; });
}

inline silvasim::base::Point random_place(Random& random, const Box& box) {
  return {between(random, box.west, box.east), between(random, box.south, box.north)};
}

// The block whose south-west node is next to the place.
inline NodeBlock block_near(const silvasim::base::Point& place, double step_m) {
  return {static_cast<std::int64_t>(std::floor(place.x / step_m)),
          static_cast<std::int64_t>(std::floor(place.y / step_m)), step_m};
}

}  // namespace ghosttile::cover::test
