// Reading a raster between its cells.
#include <cmath>
#include <limits>
#include <random>

#include "silvasim/fields/raster.h"
#include "support.h"

namespace silvasim::fields {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

Field field_over(Raster raster, config::FieldKind kind = config::FieldKind::value) {
  Field field;
  field.kind = kind;
  field.raster = std::move(raster);
  return field;
}

Raster random_raster(std::mt19937& random, double west, double north, double width, double height) {
  Raster raster;
  raster.columns = 1 + static_cast<int>(random() % 40);
  raster.rows = 1 + static_cast<int>(random() % 40);
  raster.west = west;
  raster.north = north;
  raster.cell_width = width;
  raster.cell_height = height;
  std::uniform_real_distribution<float> value(-1000, 1000);
  for (int i = 0; i < raster.columns * raster.rows; ++i) raster.values.push_back(value(random));
  return raster;
}

// The definition of bilinear reading, written without care for speed: each of the four cells weighs the area that a cell-sized
// square around the point covers of it.
double by_definition(const Raster& raster, double x, double y) {
  const double column = (x - raster.west) / raster.cell_width, row = (raster.north - y) / raster.cell_height;
  double sum = 0;
  for (int dr = -1; dr <= 1; ++dr) {
    for (int dc = -1; dc <= 1; ++dc) {
      const int c = static_cast<int>(std::floor(column)) + dc, r = static_cast<int>(std::floor(row)) + dr;
      const double weight =
          std::max(0.0, 1 - std::abs(column - (c + 0.5))) * std::max(0.0, 1 - std::abs(row - (r + 0.5)));
      sum += weight * raster.at(std::clamp(c, 0, raster.columns - 1), std::clamp(r, 0, raster.rows - 1));
    }
  }
  return sum;
}

TEST(Sample, CellCentreReturnsTheCellExactly) {
  std::mt19937 random(4711);
  const double cells[] = {30, 0.1, 29.95, 1.0 / 3, 1000};
  for (int round = 0; round < 200; ++round) {
    const double cell = cells[random() % 5];
    const Raster raster =
        random_raster(random, 125349.015334792668 + random() % 900000, 5213641.545039580203593, cell, cell * 1.7);
    for (const auto kind : {config::FieldKind::value, config::FieldKind::class_code}) {
      const Field field = field_over(raster, kind);
      for (int row = 0; row < raster.rows; ++row) {
        for (int column = 0; column < raster.columns; ++column) {
          const Sampled s = sample_at(field, raster.west + (column + 0.5) * raster.cell_width,
                                      raster.north - (row + 0.5) * raster.cell_height);
          ASSERT_FALSE(s.no_data) << "seed 4711, round " << round;
          ASSERT_EQ(s.value, raster.at(column, row))
              << "seed 4711, round " << round << " column " << column << " row " << row;
        }
      }
    }
  }
}

TEST(Sample, BilinearAsDefined) {
  std::mt19937 random(815);
  for (int round = 0; round < 300; ++round) {
    const Raster raster = random_raster(random, 600000, 5200000, 20, 25);
    const Field field = field_over(raster);
    const base::Box box = raster.extent();
    std::uniform_real_distribution<double> x(box.west, box.east), y(box.south, box.north);
    for (int i = 0; i < 50; ++i) {
      const double px = x(random), py = y(random);
      const Sampled s = sample_at(field, px, py);
      ASSERT_FALSE(s.no_data);
      ASSERT_NEAR(s.value, by_definition(raster, px, py), 2e-3) << "seed 815, round " << round;
    }
  }
}

TEST(Sample, EqualNeighboursGiveTheirValueExactly) {
  Raster raster{4, 3, 0, 30, 10, 10, std::vector<float>(12, 0.1f)};
  const Field field = field_over(raster);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> x(0, 40), y(0, 30);
  for (int i = 0; i < 10000; ++i) ASSERT_EQ(sample_at(field, x(random), y(random)).value, 0.1f);
}

TEST(Sample, EdgeAndOutside) {
  const Raster raster{2, 2, 100, 220, 10, 10, {1, 2, 3, 4}};
  const Field value = field_over(raster), code = field_over(raster, config::FieldKind::class_code);
  for (const Field& field : {value, code}) {
    // The rim belongs to the grid; between the outermost centres and the rim the edge's value holds.
    EXPECT_EQ(sample_at(field, 100, 220).value, 1);
    EXPECT_EQ(sample_at(field, 120, 220).value, 2);
    EXPECT_EQ(sample_at(field, 120, 200).value, 4);
    EXPECT_EQ(sample_at(field, 101, 201).value, 3);
    for (const auto& [x, y] : {std::pair{99.9, 210.0},
                               {120.1, 210.0},
                               {110.0, 220.1},
                               {110.0, 199.9},
                               {-1e300, 210.0},
                               {std::numeric_limits<double>::quiet_NaN(), 210.0},
                               {110.0, std::numeric_limits<double>::infinity()}}) {
      const Sampled s = sample_at(field, x, y);
      EXPECT_TRUE(s.no_data) << x << " " << y;
      EXPECT_EQ(s.value, 0);
    }
  }
  EXPECT_EQ(sample_at(value, 110, 210).value, 2.5f);
  EXPECT_EQ(sample_at(value, 110, 218).value, 1.5f);
}

TEST(Sample, MissingCells) {
  const Raster raster{2, 2, 0, 20, 10, 10, {1, nan, 3, 5}};
  const Field field = field_over(raster);
  EXPECT_TRUE(sample_at(field, 15, 15).no_data) << "the cell itself";
  EXPECT_TRUE(sample_at(field, 12, 14).no_data) << "nearest to the missing cell";
  EXPECT_EQ(sample_at(field, 5, 15).value, 1) << "a centre needs no neighbour";
  // At (8, 8): u = 0.3, v = 0.7; weights 0.21 of 1, 0.09 missing, 0.49 of 3, 0.21 of 5, scaled by 1 / 0.91.
  const Sampled s = sample_at(field, 8, 8);
  EXPECT_FALSE(s.no_data);
  EXPECT_NEAR(s.value, (0.21 * 1 + 0.49 * 3 + 0.21 * 5) / 0.91, 1e-6);
  // An infinity that a caller put there counts as missing: what comes out is finite.
  const Raster infinite{2, 1, 0, 10, 10, 10, {1, std::numeric_limits<float>::infinity()}};
  EXPECT_EQ(sample_at(field_over(infinite), 8, 5).value, 1);
  EXPECT_TRUE(sample_at(field_over(infinite), 15, 5).no_data);
  const Raster huge{2, 1, 0, 10, 10, 10, {-3.4e38f, 3.4e38f}};
  EXPECT_TRUE(std::isfinite(sample_at(field_over(huge), 8, 5).value));
}

TEST(Sample, EmptyRasterHasNoData) { EXPECT_TRUE(sample_at(field_over({}), 0, 0).no_data); }

}  // namespace
}  // namespace silvasim::fields
