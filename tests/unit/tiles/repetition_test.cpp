// What the seamless mode costs: how much of the ground repeats at the period of the tiles.
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "tests/unit/tiles/measure.h"

namespace silvasim::tiles {
namespace {

using config::TileMode;

struct Repetition {
  double next = 0;      // autocorrelation of the covered ground with that one tile further
  double diagonal = 0;  // one tile further both ways
  double far = 0;       // seven tiles east and five north
  double off = 0;       // no whole number of tiles
  double vertex = 0;    // seven and five tiles away, within 2 Rmax of a vertex only
};

Repetition repetition(const config::TileSettings& settings, int seeds) {
  const double side = settings.side_m, most = settings.most_radius_m;
  const std::array<std::array<double, 2>, 5> lags{{{1, 0}, {1, 1}, {7, 5}, {7.37, 5.41}, {7, 5}}};
  std::array<double, 5> sums{};
  for (int seed = 1; seed <= seeds; ++seed) {
    const TileSet set = fill_tiles(settings, static_cast<std::uint64_t>(seed));
    const Tiling land = tile_land(set, 60, 60, static_cast<std::uint64_t>(seed));
    const Ground ground(set, land);
    base::Stream random(static_cast<std::uint64_t>(seed), base::Purpose::rotation);
    for (std::size_t l = 0; l < lags.size(); ++l) {
      double n = 0, a = 0, b = 0, ab = 0;
      for (int i = 0; i < 100'000; ++i) {
        double x = side * (1 + 50 * random.next_double()), y = side * (1 + 50 * random.next_double());
        if (l == 4) {
          // Draw near a vertex.
          x = side * std::round(x / side) + 4 * most * (random.next_double() - 0.5);
          y = side * std::round(y / side) + 4 * most * (random.next_double() - 0.5);
        }
        const bool here = ground.covered(x, y), there = ground.covered(x + lags[l][0] * side, y + lags[l][1] * side);
        n += 1, a += here, b += there, ab += here && there;
      }
      const double cross = ab / n - a / n * b / n;
      sums[l] += cross / std::sqrt((a / n - a / n * a / n) * (b / n - b / n * b / n)) / seeds;
    }
  }
  return {sums[0], sums[1], sums[2], sums[3], sums[4]};
}

std::string text(const Repetition& r) {
  return "next " + std::to_string(r.next) + ", diagonal " + std::to_string(r.diagonal) + ", far " +
         std::to_string(r.far) + ", off " + std::to_string(r.off) + ", vertex " + std::to_string(r.vertex);
}

// The vertices of `paper` do not repeat as those of `seamless` do. That is its price; over the whole ground both repeat alike,
// for the strips of `seamless` are half as wide.
TEST(Repetition, SeamlessRepeatsItsVerticesPaperDoesNot) {
  const auto compare = [](double least, double most, double side, int colours, int variants) {
    const std::string name = std::to_string(static_cast<int>(most)) + "_" + std::to_string(static_cast<int>(side)) +
                             "_" + std::to_string(colours);
    SCOPED_TRACE(name);
    const auto settings = [&](TileMode mode) { return settings_with(mode, least, most, side, 0.5, colours, variants); };
    const Repetition paper = repetition(settings(TileMode::paper), 4);
    const Repetition seamless = repetition(settings(TileMode::seamless), 4);
    testing::Test::RecordProperty("paper_" + name, text(paper));
    testing::Test::RecordProperty("seamless_" + name, text(seamless));
    // Around a vertex everything but the corners between the patch's arms is the same.
    EXPECT_GT(seamless.vertex, 0.7);
    EXPECT_LT(paper.vertex, seamless.vertex - 0.2);
    EXPECT_NEAR(seamless.far, paper.far, 0.06);
    // The whole ground repeats no more than tiles, strips and patch can.
    const double patch = 15.3 * most * most / side / side, strips = 4 * most / side;
    EXPECT_LT(seamless.far, patch + strips / colours + 1.0 / (colours * colours * variants) + 0.03);
    // Off the period nothing repeats.
    EXPECT_NEAR(paper.off, 0, 0.015);
    EXPECT_NEAR(seamless.off, 0, 0.015);
  };
  compare(5, 9, 200, 3, 2);
  compare(2, 8, 80, 3, 2);
  compare(5, 9, 200, 6, 5);
}

}  // namespace
}  // namespace silvasim::tiles
