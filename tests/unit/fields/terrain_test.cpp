// Measures derived from heights.
#include "silvasim/fields/terrain.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "silvasim/fields/arctangent.h"
#include "silvasim/fields/wetness.h"
#include "support.h"

namespace silvasim::fields {
namespace {

using config::TerrainMeasure;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

Raster surface(int columns, int rows, double cell_width, double cell_height,
               const std::function<double(double, double)>& height) {
  Raster raster{columns, rows, 0, rows * cell_height, cell_width, cell_height, {}};
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      raster.values.push_back(
          static_cast<float>(height((column + 0.5) * cell_width, raster.north - (row + 0.5) * cell_height)));
    }
  }
  return raster;
}

// The largest difference to a file of gdaldem's, over the cells where it has a value.
struct Agreement {
  double worst = 0;
  long compared = 0, ours_missing = 0;
};

Agreement agreement(const Raster& ours, const std::filesystem::path& reference, int shift_column, int shift_row,
                    double period = 0) {
  auto field = raster_field(reference);
  const FieldSet set = load_fields({}, {field});
  const Raster& theirs = set.fields[0].raster;
  Agreement result;
  for (int row = 0; row < theirs.rows; ++row) {
    for (int column = 0; column < theirs.columns; ++column) {
      const float b = theirs.at(column, row);
      if (std::isnan(b)) continue;
      const float a = ours.at(column + shift_column, row + shift_row);
      if (std::isnan(a)) {
        ++result.ours_missing;
        continue;
      }
      double difference = std::abs(double(a) - b);
      if (period > 0) difference = std::min(difference, period - difference);
      result.worst = std::max(result.worst, difference);
      ++result.compared;
    }
  }
  return result;
}

TEST(Terrain, AgreesWithGdaldem) {
  NEED_SHARED("nc_wake/reference/slope_gdaldem.tif");
  const FieldSet set =
      load_fields({}, {raster_field(shared("nc_wake/elev_ned_30m.tif"), true), derived_field(TerrainMeasure::slope_deg),
                       derived_field(TerrainMeasure::aspect_deg), derived_field(TerrainMeasure::tpi),
                       derived_field(TerrainMeasure::tri)});
  const auto check = [&](std::size_t field, const char* name, double tolerance, double period = 0) {
    const Agreement a =
        agreement(set.fields[field].raster, shared(std::string("nc_wake/reference/") + name), 0, 0, period);
    EXPECT_GT(a.compared, 223000) << name;
    EXPECT_EQ(a.ours_missing, 0) << name;
    EXPECT_LT(a.worst, tolerance) << name;
  };
  check(1, "slope_gdaldem.tif", 1e-6);
  check(2, "aspect_gdaldem.tif", 1e-4, 360);
  check(3, "tpi_gdaldem.tif", 1e-6);
  check(4, "tri_gdaldem.tif", 1e-6);
}

TEST(Terrain, SlopeOfRainierAgreesWithGdaldem) {
  NEED_SHARED("rainier/reference/slope_gdaldem_crop_x300_y250_300x300.tif");
  const FieldSet set = load_fields(
      {}, {raster_field(shared("rainier/dem_ned_30m.tif"), true), derived_field(TerrainMeasure::slope_deg)});
  const Agreement a =
      agreement(set.fields[1].raster, shared("rainier/reference/slope_gdaldem_crop_x300_y250_300x300.tif"), 300, 250);
  EXPECT_GT(a.compared, 89000);
  EXPECT_LT(a.worst, 1e-6);
}

// A plane has the same slope and aspect everywhere, up to its rim and beside a hole; the truth is plain trigonometry.
TEST(Terrain, PlaneUpToItsRim) {
  for (const double bearing : {0.0, 45.0, 90.0, 137.0, 180.0, 260.0, 359.0}) {
    for (const double steep : {0.5, 20.0, 70.0}) {
      const double toward = bearing * pi / 180, drop = std::tan(steep * pi / 180);
      Raster raster = surface(9, 7, 30, 20, [&](double x, double y) {
        return 1000 - drop * (x * std::sin(toward) + y * std::cos(toward));
      });
      raster.values[3 * 9 + 4] = nan;
      const Raster slope = derive(TerrainMeasure::slope_deg, raster),
                   aspect = derive(TerrainMeasure::aspect_deg, raster);
      const Raster northness = derive(TerrainMeasure::northness, raster),
                   eastness = derive(TerrainMeasure::eastness, raster);
      const Raster curvature = derive(TerrainMeasure::curvature, raster);
      for (std::size_t i = 0; i < raster.values.size(); ++i) {
        if (std::isnan(raster.values[i])) {
          EXPECT_TRUE(std::isnan(slope.values[i]) && std::isnan(aspect.values[i]) && std::isnan(curvature.values[i]));
          continue;
        }
        EXPECT_NEAR(slope.values[i], steep, 2e-3) << bearing << " " << steep << " cell " << i;
        const double turn = std::abs(aspect.values[i] - bearing);
        EXPECT_NEAR(std::min(turn, 360 - turn), 0, 2e-2) << bearing << " " << steep << " cell " << i;
        EXPECT_NEAR(northness.values[i], std::cos(toward) * std::sin(steep * pi / 180), 1e-4);
        EXPECT_NEAR(eastness.values[i], std::sin(toward) * std::sin(steep * pi / 180), 1e-4);
        EXPECT_NEAR(curvature.values[i], 0, 5e-6);
      }
    }
  }
}

// Two slopes that face 10 degrees west and east of north: between them lies no south.
TEST(Terrain, AspectIsNotInterpolated) {
  NEED_SHARED("nc_wake/elev_ned_30m.tif");
  const FieldSet set = load_fields(
      {}, {raster_field(shared("nc_wake/elev_ned_30m.tif"), true), derived_field(TerrainMeasure::aspect_deg)});
  const Raster& aspect = set.fields[1].raster;
  int across = 0;
  for (int row = 1; row < aspect.rows - 1; ++row) {
    for (int column = 1; column + 2 < aspect.columns; ++column) {
      const float west = aspect.at(column, row), east = aspect.at(column + 1, row);
      if (!(west > 330 && east < 30)) continue;
      ++across;
      const Sampled s = sample_at(set.fields[1], aspect.west + (column + 0.9) * 30, aspect.north - (row + 0.5) * 30);
      ASSERT_TRUE(s.value > 330 || s.value < 30);
    }
  }
  EXPECT_GT(across, 100);
}

TEST(Terrain, FlatGround) {
  const Raster flat = surface(5, 5, 10, 10, [](double, double) { return 123; });
  for (const float value : derive(TerrainMeasure::slope_deg, flat).values) EXPECT_EQ(value, 0);
  for (const float value : derive(TerrainMeasure::aspect_deg, flat).values) EXPECT_TRUE(std::isnan(value));
  for (const float value : derive(TerrainMeasure::northness, flat).values) EXPECT_EQ(value, 0);
  for (const float value : derive(TerrainMeasure::tpi, flat).values) EXPECT_EQ(value, 0);
  for (const float value : derive(TerrainMeasure::tri, flat).values) EXPECT_EQ(value, 0);
  for (const float value : derive(TerrainMeasure::hillshade, flat).values) EXPECT_NEAR(value, std::sqrt(0.5), 1e-6);
  const Raster single = surface(1, 1, 10, 10, [](double, double) { return 5; });
  EXPECT_EQ(derive(TerrainMeasure::slope_deg, single).values[0], 0);
  EXPECT_TRUE(std::isnan(derive(TerrainMeasure::tpi, single).values[0]));
  EXPECT_TRUE(std::isfinite(derive(TerrainMeasure::wetness, single).values[0]));
  const Raster line = surface(1, 9, 10, 10, [](double, double y) { return y; });
  EXPECT_NEAR(derive(TerrainMeasure::slope_deg, line).values[4], 45, 1e-4);
}

TEST(Terrain, HollowsCurveUpwards) {
  // z = (x^2 + y^2) / 2r has the Laplacian 2 / r.
  const Raster bowl = surface(
      21, 21, 10, 10, [](double x, double y) { return ((x - 105) * (x - 105) + (y - 105) * (y - 105)) / 1000; });
  EXPECT_NEAR(derive(TerrainMeasure::curvature, bowl).at(10, 10), 4.0 / 1000, 1e-6);
  EXPECT_LT(derive(TerrainMeasure::tpi, bowl).at(10, 10), 0);
}

TEST(Terrain, HillshadeLooksFromTheNorthWest) {
  const Raster to_light = surface(5, 5, 10, 10, [](double x, double y) { return x - y; });  // falls to the north-west
  const Raster to_dark = surface(5, 5, 10, 10, [](double x, double y) { return y - x; });
  const double lit = derive(TerrainMeasure::hillshade, to_light).at(2, 2),
               dark = derive(TerrainMeasure::hillshade, to_dark).at(2, 2);
  EXPECT_GT(lit, 0.9);
  EXPECT_EQ(dark, 0);
}

// The fast disc against every cell of it, one by one.
TEST(Terrain, PositionInADiscAsDefined) {
  std::mt19937 random(99);
  for (int round = 0; round < 20; ++round) {
    const double width = 5 + double(random() % 20), height = 5 + double(random() % 20),
                 radius = 20 + double(random() % 100);
    Raster raster =
        surface(3 + static_cast<int>(random() % 30), 3 + static_cast<int>(random() % 30), width, height,
                [&](double, double) { return random() % 10 == 0 ? NAN : 500 + double(random() % 1000) / 10; });
    const Raster fast = derive(TerrainMeasure::tpi, raster, radius);
    for (int row = 0; row < raster.rows; ++row) {
      for (int column = 0; column < raster.columns; ++column) {
        double sum = 0;
        int count = 0;
        for (int r = 0; r < raster.rows; ++r) {
          for (int c = 0; c < raster.columns; ++c) {
            const double dx = (c - column) * width, dy = (r - row) * height;
            if ((c == column && r == row) || dx * dx + dy * dy > radius * radius * (1 + 1e-12) ||
                std::isnan(raster.at(c, r)))
              continue;
            sum += raster.at(c, r);
            ++count;
          }
        }
        const float centre = raster.at(column, row);
        if (std::isnan(centre) || count == 0)
          ASSERT_TRUE(std::isnan(fast.at(column, row))) << "seed 99, round " << round;
        else
          ASSERT_NEAR(fast.at(column, row), centre - sum / count, 1e-3) << "seed 99, round " << round;
      }
    }
  }
}

TEST(Terrain, ArctangentIsTheLibrarys) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  double worst = 0;
  for (int i = 0; i < 200000; ++i) {
    const double y = normal(random) * std::exp(5 * normal(random)), x = normal(random) * std::exp(5 * normal(random));
    const double truth = std::atan2(y, x);
    worst = std::max(worst, std::abs(arctangent(y, x) - truth) / std::max(std::abs(truth), 1e-300));
  }
  EXPECT_LT(worst, 4 * 2.3e-16);
  EXPECT_EQ(arctangent(0, 0), 0);
  EXPECT_EQ(arctangent(0, -1), pi);
  EXPECT_EQ(arctangent(1, 0), pi / 2);
}

// ---- Water.

TEST(Wetness, FilledLandHasNoHollow) {
  std::mt19937 random(12);
  for (int round = 0; round < 20; ++round) {
    const Raster raster = surface(4 + static_cast<int>(random() % 30), 4 + static_cast<int>(random() % 30), 10, 10,
                                  [&](double, double) { return random() % 30 == 0 ? NAN : double(random() % 200); });
    const std::vector<float> filled = filled_heights(raster);
    // A second way: raise every cell as long as it lies below its lowest way out (iterated to rest).
    std::vector<float> level(raster.values.size(), std::numeric_limits<float>::infinity());
    const auto outlet = [&](int c, int r) {
      for (int dr = -1; dr <= 1; ++dr) {
        for (int dc = -1; dc <= 1; ++dc) {
          const int cc = c + dc, rr = r + dr;
          if (cc < 0 || rr < 0 || cc >= raster.columns || rr >= raster.rows || std::isnan(raster.at(cc, rr)))
            return true;
        }
      }
      return false;
    };
    for (bool changed = true; changed;) {
      changed = false;
      for (int r = 0; r < raster.rows; ++r) {
        for (int c = 0; c < raster.columns; ++c) {
          const auto i = static_cast<std::size_t>(r * raster.columns + c);
          if (std::isnan(raster.values[i])) continue;
          float best = std::numeric_limits<float>::infinity();
          if (outlet(c, r)) {
            best = raster.values[i];
          } else {
            for (int dr = -1; dr <= 1; ++dr) {
              for (int dc = -1; dc <= 1; ++dc)
                best = std::min(best, level[static_cast<std::size_t>((r + dr) * raster.columns + c + dc)]);
            }
            best = std::max(best, raster.values[i]);
          }
          if (best < level[i]) {
            level[i] = best;
            changed = true;
          }
        }
      }
    }
    for (std::size_t i = 0; i < level.size(); ++i) {
      if (std::isnan(raster.values[i]))
        ASSERT_TRUE(std::isnan(filled[i]));
      else
        ASSERT_EQ(filled[i], level[i]) << "seed 12, round " << round << " cell " << i;
    }
  }
}

TEST(Wetness, NoWaterIsLost) {
  std::mt19937 random(34);
  for (int round = 0; round < 20; ++round) {
    const Raster raster = surface(3 + static_cast<int>(random() % 40), 3 + static_cast<int>(random() % 40), 20, 25,
                                  [&](double, double) { return random() % 50 == 0 ? NAN : double(random() % 100); });
    const std::vector<double> area = catchment_area_m2(raster);
    double fell = 0, left = 0;
    for (int r = 0; r < raster.rows; ++r) {
      for (int c = 0; c < raster.columns; ++c) {
        if (std::isnan(raster.at(c, r))) continue;
        fell += 500;
        bool outlet = false;
        for (int dr = -1; dr <= 1; ++dr) {
          for (int dc = -1; dc <= 1; ++dc) {
            const int cc = c + dc, rr = r + dr;
            outlet = outlet || cc < 0 || rr < 0 || cc >= raster.columns || rr >= raster.rows ||
                     std::isnan(raster.at(cc, rr));
          }
        }
        const double here = area[static_cast<std::size_t>(r * raster.columns + c)];
        ASSERT_GE(here, 500 * (1 - 1e-9));
        if (outlet) left += here;
      }
    }
    EXPECT_NEAR(left, fell, 1e-6 * fell) << "seed 34, round " << round;
  }
}

// On a plane that falls south every column is a gutter: the area grows by one cell a row.
TEST(Wetness, PlaneDrainsDownhill) {
  const Raster plane = surface(41, 41, 10, 10, [](double, double y) { return y * 0.5; });
  const std::vector<double> area = catchment_area_m2(plane);
  for (int row = 1; row < 20; ++row)
    EXPECT_NEAR(area[static_cast<std::size_t>(row * 41 + 20)], 100.0 * row, 1.0 + 100) << row;
  const Raster index = wetness_index(plane);
  EXPECT_GT(index.at(20, 35), index.at(20, 5));
  EXPECT_NEAR(index.at(20, 20), std::log(area[20 * 41 + 20] / 10 / 0.5), 1e-5);
}

double rank_correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const auto ranks = [](const std::vector<double>& values) {
    std::vector<std::size_t> order(values.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return values[i] < values[j]; });
    std::vector<double> rank(values.size());
    for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = double(i);
    return rank;
  };
  const std::vector<double> x = ranks(a), y = ranks(b);
  const double mean = double(a.size() - 1) / 2;
  double xy = 0, xx = 0, yy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xy += (x[i] - mean) * (y[i] - mean);
    xx += (x[i] - mean) * (x[i] - mean);
    yy += (y[i] - mean) * (y[i] - mean);
  }
  return xy / std::sqrt(xx * yy);
}

// Band 3 of this file is log10 of the catchment area, computed by somebody else's program (SAGA).
TEST(Wetness, AgreesWithAnotherProgramsCatchments) {
  NEED_SHARED("mongon/dem_ndvi_carea_cslope.tif");
  const auto path = shared("mongon/dem_ndvi_carea_cslope.tif");
  auto carea = raster_field(path);
  carea.band = 3;
  const FieldSet set = load_fields({}, {raster_field(path, true), carea});
  const std::vector<double> area = catchment_area_m2(set.fields[0].raster);
  std::vector<double> ours, theirs;
  for (int row = 5; row < 112; ++row) {
    for (int column = 5; column < 112; ++column) {
      ours.push_back(area[static_cast<std::size_t>(row * 117 + column)]);
      theirs.push_back(set.fields[1].raster.at(column, row));
    }
  }
  const double agreement = rank_correlation(ours, theirs);
  EXPECT_GT(agreement, 0.9);
}

TEST(Wetness, HigherInTheValleys) {
  NEED_SHARED("nc_wake/streams.shp");
  auto streams = vector_field(shared("nc_wake/streams.shp"), config::VectorMeasure::distance);
  streams.resolution_m = 30;
  const FieldSet set = load_fields(
      {}, {raster_field(shared("nc_wake/elev_ned_30m.tif"), true), derived_field(TerrainMeasure::wetness), streams});
  double near = 0, far = 0;
  int near_count = 0, far_count = 0;
  const Raster& wet = set.fields[1].raster;
  for (int row = 0; row < wet.rows; ++row) {
    for (int column = 0; column < wet.columns; ++column) {
      const Sampled metres = sample_at(set.fields[2], wet.west + (column + 0.5) * 30, wet.north - (row + 0.5) * 30);
      if (metres.no_data || std::isnan(wet.at(column, row))) continue;
      if (metres.value < 30) near += wet.at(column, row), ++near_count;
      if (metres.value > 150) far += wet.at(column, row), ++far_count;
    }
  }
  EXPECT_GT(near / near_count, far / far_count + 1);
}

}  // namespace
}  // namespace silvasim::fields
