#include "ghosttile/density/ground_plane.h"

#include <gtest/gtest.h>

#include "fields.h"

namespace ghosttile::density::test {
namespace {

Terrain random_terrain(unsigned seed, bool holes) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> height(500, 700);
  Terrain terrain;
  terrain.columns = 1 + static_cast<int>(random() % 40);
  terrain.rows = 1 + static_cast<int>(random() % 40);
  terrain.west = 400000.5;
  terrain.north = 5000000.25;
  terrain.cell_width_m = 3.7;
  terrain.cell_height_m = 2.9;
  for (int i = 0; i < terrain.columns * terrain.rows; ++i)
    terrain.heights_m.push_back(holes && random() % 6 == 0 ? std::numeric_limits<float>::quiet_NaN() : height(random));
  return terrain;
}

TEST(GroundPlane, EqualsHeightAtAndStaysWithinItsBounds) {
  std::size_t tight = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Terrain terrain = random_terrain(seed, seed % 2 == 1);
    const auto plane = ground_plane(terrain);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(-0.1, 1.1), side_m(0, seed % 3 == 0 ? 0.6 : seed % 3 == 1 ? 8 : 60);
    for (int round = 0; round < 20; ++round) {
      const V3d corner(terrain.west + share(random) * terrain.columns * 3.7,
                       terrain.north - share(random) * terrain.rows * 2.9, 0);
      const double wide_m = side_m(random), high_m = side_m(random);
      std::vector<float> x(block_size), y(block_size), value(block_size);
      for (std::size_t i = 0; i < block_size; ++i) {
        x[i] = static_cast<float>(std::clamp(share(random), 0.0, 1.0) * wide_m);
        y[i] = static_cast<float>(std::clamp(share(random), 0.0, 1.0) * high_m);
      }
      plane->sample(corner, x.data(), y.data(), block_size, value.data());
      const Range range = plane->bounds(corner.x, corner.y, corner.x + wide_m + 1e-6, corner.y + high_m + 1e-6);
      float least = value[0], most = value[0];
      for (std::size_t i = 0; i < block_size; ++i) {
        const double want = silvasim::ecosystem::height_at(
            terrain, {corner.x + static_cast<double>(x[i]), corner.y + static_cast<double>(y[i])});
        ASSERT_EQ(value[i], static_cast<float>(want)) << x[i] << " " << y[i];
        ASSERT_GE(value[i], range.least);
        ASSERT_LE(value[i], range.most);
        least = std::min(least, value[i]);
        most = std::max(most, value[i]);
      }
      // A tile of half a metre lies in a cell or across its rim; a height changes by at most 200 m a cell there.
      if (seed % 6 == 0) {
        EXPECT_LE(range.most - range.least, (most - least) * 1.3f + 0.01f);
        ++tight;
      }
    }
  }
  EXPECT_GT(tight, 1000u);
}

TEST(GroundPlane, BoundsOfEverythingAreTheLeastAndTheGreatest) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Terrain terrain = random_terrain(seed, false);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const auto [least, most] = std::minmax_element(terrain.heights_m.begin(), terrain.heights_m.end());
    const Range all = ground_plane(terrain)->bounds(-infinity, -infinity, infinity, infinity);
    EXPECT_NEAR(all.least, *least, 1e-4f);
    EXPECT_NEAR(all.most, *most, 1e-4f);
  }
}

// One hole somewhere does not widen the bounds elsewhere.
TEST(GroundPlane, BoundsOfATileOnACoarseSlopeAreItsOwn) {
  Terrain terrain;
  terrain.columns = terrain.rows = 20;
  terrain.north = 600;
  terrain.cell_width_m = terrain.cell_height_m = 30;
  for (int i = 0; i < 400; ++i) terrain.heights_m.push_back(static_cast<float>(30 * (i % 20)));
  terrain.heights_m[399] = std::numeric_limits<float>::quiet_NaN();
  const Range range = ground_plane(terrain)->bounds(100, 100, 100.5, 100.5);
  EXPECT_NEAR(range.least, 85, 1e-3f);
  EXPECT_NEAR(range.most, 85.5f, 1e-3f);
}

TEST(GroundPlane, EmptyTerrainIsFlatLandAtZero) {
  const Terrain none;
  const auto plane = ground_plane(none);
  float x = 3, value = 7;
  plane->sample(V3d(10, 20, 30), &x, &x, 1, &value);
  EXPECT_EQ(value, 0);
  EXPECT_EQ(plane->bounds(0, 0, 1, 1).most, 0);
  flat_plane(2.5f)->sample(V3d(10, 20, 30), &x, &x, 1, &value);
  EXPECT_EQ(value, 2.5f);
}

TEST(GroundPlane, SlopeOfATiltedPlainIsItsTangent) {
  Terrain terrain = random_terrain(5, false);
  std::size_t i = 0;
  for (int row = 0; row < terrain.rows; ++row)
    for (int column = 0; column < terrain.columns; ++column)
      terrain.heights_m[i++] = static_cast<float>(0.3 * 3.7 * column - 0.4 * 2.9 * row);
  terrain.heights_m[terrain.heights_m.size() / 2] = std::numeric_limits<float>::quiet_NaN();
  ASSERT_GT(std::min(terrain.columns, terrain.rows), 3);
  const auto slopes = slopes_of(terrain).heights_m;
  for (std::size_t k = 0; k < slopes.size(); ++k) {
    if (std::isnan(terrain.heights_m[k])) continue;
    EXPECT_NEAR(slopes[k], 0.5f, 1e-4f) << k;
  }
  float x = 5, value = 0;
  slope_plane(terrain)->sample(V3d(terrain.west, terrain.north - 20, 0), &x, &x, 1, &value);
  EXPECT_NEAR(value, 0.5f, 1e-4f);
}

// The whole: litter over rough ground, cut to tiles, beside litter worked out point by point.
TEST(GroundPlane, ALayerFollowsTheGround) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Terrain terrain = random_terrain(seed, seed % 3 == 0);
    for (float& height : terrain.heights_m) height = 500 + (height - 500) * 0.01f;
    Node layer;
    layer.kind = Kind::layer;
    layer.to_m = 0.1;
    layer.radius_m = 0.4;
    layer.plane = ground_plane(terrain);
    const Field field(layer);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(0, 1);
    std::size_t inside = 0;
    for (int tile = 0; tile < 40; ++tile) {
      const V3d corner(terrain.west + share(random) * 3.7 * terrain.columns,
                       terrain.north - share(random) * 2.9 * terrain.rows, 500 + 2 * share(random));
      const Box3 box{corner, corner + V3d(0.5)};
      const Compiled compiled = field.compiled(corner, box);
      const auto places = places_in(box, corner, 100, random);
      const auto values = values_at(compiled, places);
      for (std::size_t i = 0; i < places.size(); ++i) {
        ASSERT_NEAR(values[i], value_of(layer, corner + V3d(places[i])), 5e-4);
        ASSERT_LE(values[i], compiled.range.most);
        ASSERT_GE(values[i], compiled.range.least);
        inside += values[i] > 0;
      }
    }
    EXPECT_GT(inside, 0u);
  }
}

}  // namespace
}  // namespace ghosttile::density::test
