#include "silvasim/export/ground.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "made_land.h"

namespace silvasim::exports {
namespace {

ecosystem::Terrain terrain_of(int columns, int rows, double cell, auto&& height) {
  ecosystem::Terrain terrain{columns, rows, 0, rows * cell, cell, cell, {}};
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      terrain.heights_m.push_back(static_cast<float>(height((i + 0.5) * cell, (rows - j - 0.5) * cell)));
    }
  }
  return terrain;
}

View view_of(const ecosystem::Terrain& terrain, int width) {
  const double w = terrain.columns * terrain.cell_width_m, h = terrain.rows * terrain.cell_height_m;
  return {{0, 0, w, h}, width, std::max(1, static_cast<int>(width * h / w))};
}

TEST(Ground, slopes_to_the_north_west_are_light_and_to_the_south_east_dark) {
  // A cone; cells coarser, as fine and finer than pixels.
  for (const double cell : {2.0, 10.0, 50.0}) {
    const int cells = static_cast<int>(1000 / cell);
    const auto terrain =
        terrain_of(cells, cells, cell, [](double x, double y) { return 200 - 0.3 * std::hypot(x - 500, y - 500); });
    const Ground ground(terrain, view_of(terrain, 100));
    const auto shade = [&](double x, double y) { return ground.at(x, y).shade; };
    EXPECT_GT(shade(300, 700), 1.03f) << cell;
    EXPECT_LT(shade(700, 300), 0.9f) << cell;
    EXPECT_GT(shade(300, 700), shade(300, 300)) << cell;
    EXPECT_GT(shade(300, 300), shade(700, 300)) << cell;
    // Opposite sides of the diagonal of the main light look nearly alike.
    EXPECT_NEAR(shade(300, 300), shade(700, 700), 0.15f) << cell;
  }
}

TEST(Ground, level_land_has_one_shade) {
  const auto terrain = terrain_of(20, 30, 5, [](double, double) { return 123.0; });
  const Ground ground(terrain, view_of(terrain, 200));
  for (double x = 0.5; x < 100; x += 7) EXPECT_NEAR(ground.at(x, 50).shade, 1, 1e-5);
}

TEST(Ground, no_data_and_beyond_are_paper) {
  const auto terrain = terrain_of(40, 40, 10, [](double x, double y) {
    return x < 200 ? std::numeric_limits<double>::quiet_NaN() : 0.5 * y + std::sin(x / 20);
  });
  const Ground ground(terrain, view_of(terrain, 300));
  EXPECT_EQ(colour_of(ground.at(100, 200).light), paper_colour);
  EXPECT_EQ(ground.at(100, 200).shade, 1);
  EXPECT_EQ(colour_of(ground.at(-1, 200).light), paper_colour);
  EXPECT_EQ(colour_of(ground.at(300, 401).light), paper_colour);
  EXPECT_NE(colour_of(ground.at(300, 200).light), paper_colour);
  EXPECT_NE(ground.at(300, 200).shade, 1);
}

TEST(Ground, strange_terrains_give_finite_light) {
  const auto nan = std::numeric_limits<double>::quiet_NaN();
  const auto infinity = std::numeric_limits<double>::infinity();
  for (const auto& [columns, rows] : {std::pair{1, 1}, {1, 9}, {9, 1}, {2, 2}}) {
    for (const double value : {0.0, 1e30, -1e30, nan, infinity}) {
      const auto terrain = terrain_of(columns, rows, 3, [&](double x, double) { return x < 2 ? value : 5.0; });
      const Ground ground(terrain, view_of(terrain, 64));
      for (double x = 0; x <= columns * 3; x += 0.5) {
        const Ground::Sample sample = ground.at(x, 1.5);
        EXPECT_TRUE(std::isfinite(sample.shade) && std::isfinite(sample.light.red))
            << columns << "x" << rows << " " << value;
      }
    }
  }
  EXPECT_TRUE(Ground({}, View{{0, 0, 10, 10}, 10, 10}).plain());
}

}  // namespace
}  // namespace silvasim::exports
