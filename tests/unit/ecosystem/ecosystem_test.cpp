// The plain values and what is asked of them.
#include "silvasim/ecosystem/ecosystem.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "random_ecosystem.h"

namespace silvasim::ecosystem {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

TEST(Terrain, IsEqualToItselfWithHolesAndDiffersByBits) {
  const Terrain terrain{.columns = 2, .rows = 1, .heights_m = {nan, 0.0f}};
  Terrain other = terrain;
  EXPECT_EQ(terrain, other);
  other.heights_m[1] = -0.0f;
  EXPECT_FALSE(terrain == other);
  other = terrain;
  other.west = 1;
  EXPECT_FALSE(terrain == other);
  other = terrain;
  other.heights_m.pop_back();
  EXPECT_FALSE(terrain == other);
  EXPECT_EQ(Terrain{}, Terrain{});
}

TEST(Terrain, HeightIsBilinearAndHoldsAtTheEdge) {
  const Terrain terrain{.columns = 2,
                        .rows = 2,
                        .west = 100,
                        .north = 50,
                        .cell_width_m = 10,
                        .cell_height_m = 20,
                        .heights_m = {1, 3, 5, 11}};
  EXPECT_DOUBLE_EQ(height_at(terrain, {105, 40}), 1);
  EXPECT_DOUBLE_EQ(height_at(terrain, {115, 20}), 11);
  EXPECT_DOUBLE_EQ(height_at(terrain, {110, 30}), 5);
  EXPECT_DOUBLE_EQ(height_at(terrain, {0, 1000}), 1);
  EXPECT_DOUBLE_EQ(height_at(terrain, {1000, -1000}), 11);
  EXPECT_DOUBLE_EQ(height_at({}, {0, 0}), 0);
  const Terrain one{.columns = 1, .rows = 1, .heights_m = {7}};
  EXPECT_DOUBLE_EQ(height_at(one, {3, 3}), 7);
}

TEST(Terrain, HolesAreFilledFromTheirNeighboursOrZero) {
  const Terrain terrain{.columns = 2, .rows = 1, .heights_m = {nan, 4}};
  EXPECT_DOUBLE_EQ(height_at(terrain, {1, -0.5}), 4);
  EXPECT_DOUBLE_EQ(height_at(terrain, {0.5, -0.5}), 0);
  const Terrain hole{.columns = 1, .rows = 1, .heights_m = {nan}};
  EXPECT_DOUBLE_EQ(height_at(hole, {0.5, -0.5}), 0);
}

// The offsets, the visit and the counts tell the same story.
TEST(Layer, EveryStandingPlantIsVisitedOnceAtItsSite) {
  const std::uint64_t seed = 81;
  SCOPED_TRACE("seed " + std::to_string(seed));
  Random random(seed);
  for (int round = 0; round < 50; ++round) {
    const Layer layer = random_layer(random, {.columns = 4, .rows = 3, .species = 3, .probabilities = round % 2 == 0});
    const auto offsets = site_offsets(layer.tile_set, layer.tiling);
    ASSERT_EQ(offsets.size(), 13u);
    std::vector<PlantId> seen(layer.plants.size(), no_plant);
    std::vector<std::uint64_t> counts(3, 0);
    for_each_plant(layer, offsets, 0, layer.tiling.rows, [&](const Plant& plant) {
      const std::size_t position = static_cast<std::size_t>(plant.row * 4 + plant.column);
      const std::size_t i = offsets[position] + plant.site;
      ASSERT_LT(i, offsets[position + 1]);
      ASSERT_EQ(seen[i], no_plant);
      seen[i] = plant.species;
      ++counts[plant.species];
      const tiles::Site& site = layer.tile_set.tiles[layer.tiling.tiles[position]].sites[plant.site];
      EXPECT_EQ(plant.radius_m, site.radius_m);
      EXPECT_NEAR(plant.at.x - layer.north_west.x, plant.column * layer.tile_set.side_m + static_cast<double>(site.x_m),
                  1e-6);
      EXPECT_NEAR(layer.north_west.y - plant.at.y,
                  (plant.row + 1) * layer.tile_set.side_m - static_cast<double>(site.y_m), 1e-6);
      EXPECT_EQ(plant.probability, round % 2 == 0 ? static_cast<float>(layer.probabilities[i]) / 65535.0f : 1.0f);
    });
    EXPECT_EQ(seen, layer.plants);
    EXPECT_EQ(plants_by_species(layer), counts);
  }
}

// More than one of the blocks that are counted side by side.
TEST(Layer, CountsMillionsOfPlants) {
  Layer layer;
  layer.species.resize(2);
  layer.plants.assign(3'000'000, 1);
  for (std::size_t i = 0; i < layer.plants.size(); i += 3) layer.plants[i] = no_plant;
  layer.plants[1] = 0;
  EXPECT_EQ(plants_by_species(layer), (std::vector<std::uint64_t>{1, 1'999'999}));
}

}  // namespace
}  // namespace silvasim::ecosystem
