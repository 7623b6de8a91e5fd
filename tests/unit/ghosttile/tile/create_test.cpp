#include "ghosttile/tile/create.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ghosttile/tile/sphere_columns.h"
#include "silvasim/base/error.h"
#include "silvasim/base/parallel.h"
#include "tests/unit/ghosttile/tile/made_details.h"

namespace ghosttile::tile {
namespace {

Spread spread_of(std::uint32_t count, std::vector<Tilt> tilts = {}) {
  Spread spread;
  spread.count = count;
  spread.least_scale = 0.7f;
  spread.most_scale = 1.3f;
  spread.tilts = std::move(tilts);
  return spread;
}

GhostTile mixed_tile(float side_m, float delta_m, std::uint64_t seed) {
  CreateOptions options;
  options.side_m = side_m;
  options.delta_m = delta_m;
  options.seed = seed;
  options.spreads = {spread_of(90), spread_of(70, {{0, 30, 3}, {45, 60, 1}})};
  return create({lump(0.05f, 21, 7), twig(0.3f, 0.01f, 15)}, options);
}

// A candidate's spheres in doubles, and the gap between two candidates straight from the paper's formula.
struct Ball {
  std::array<double, 3> at;
  double radius;
};
std::vector<std::vector<Ball>> balls_of(const GhostTile& tile) {
  std::vector<std::vector<Ball>> balls;
  for (const Candidate& candidate : tile.candidates) {
    balls.emplace_back();
    for (const auto& sphere : tile.objects[candidate.object].spheres) {
      const V3 at = candidate(sphere.centre);
      balls.back().push_back({{double{at.x}, double{at.y}, double{at.z}}, double{sphere.radius_m * candidate.scale}});
    }
  }
  return balls;
}
double gap(const std::vector<Ball>& a, const std::vector<Ball>& b, const Offset& v, double side_m) {
  double least = 1e9;
  for (const Ball& s : a) {
    for (const Ball& t : b) {
      double square = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double d = t.at[axis] + v[axis] * side_m - s.at[axis];
        square += d * d;
      }
      least = std::min(least, std::sqrt(square) - s.radius - t.radius);
    }
  }
  return least;
}

struct Setting {
  float side_m, delta_m;
  std::uint64_t seed;
};

class Graphs : public testing::TestWithParam<Setting> {};

TEST_P(Graphs, EqualBruteForceOverAllPairsAndOffsets) {
  const auto [side_m, delta_m, seed] = GetParam();
  const GhostTile tile = mixed_tile(side_m, delta_m, seed);
  const auto& graph = tile.graph;
  const auto balls = balls_of(tile);
  EXPECT_EQ(graph.problem(), "");
  std::uint64_t arcs = 0, selfs = 0;
  // One tile beyond the graph's reach as well: nothing may collide there.
  const int beyond = graph.reach + 1;
  for (std::uint32_t i = 0; i < graph.candidates; ++i) {
    for (std::uint32_t j = 0; j < graph.candidates; ++j) {
      for (int z = -beyond; z <= beyond; ++z) {
        for (int y = -beyond; y <= beyond; ++y) {
          for (int x = -beyond; x <= beyond; ++x) {
            const Offset v{x, y, z};
            const bool itself = i == j && x == 0 && y == 0 && z == 0;
            const bool collides = graph.collides(i, j, v);
            arcs += collides ? 1 : 0;
            selfs += collides && i == j ? 1 : 0;
            if (itself) {
              ASSERT_FALSE(collides);
              continue;
            }
            const double over = gap(balls[i], balls[j], v, double{tile.side_m}) - double{delta_m};
            if (std::abs(over) < 1e-6) continue;  // nearer than floats tell
            ASSERT_EQ(collides, over < 0) << i << " " << j << " " << x << " " << y << " " << z << " " << over;
          }
        }
      }
    }
  }
  EXPECT_EQ(arcs, graph.arcs());
  if (side_m < 0.3f) {
    EXPECT_GT(selfs, 0u);
  }
}

INSTANTIATE_TEST_SUITE_P(SidesAndThresholds, Graphs,
                         testing::Values(Setting{0.5f, 0, 1}, Setting{0.5f, -0.01f, 2}, Setting{0.5f, 0.02f, 3},
                                         Setting{0.25f, 0, 4}, Setting{1.0f, -0.001f, 5}),
                         [](const auto& setting) { return "Seed" + std::to_string(setting.param.seed); });

TEST(Create, IsTheSameOnAnyNumberOfThreads) {
  const silvasim::base::ThreadLimit one(1);
  const GhostTile a = mixed_tile(0.5f, 0, 9);
  const silvasim::base::ThreadLimit many(4);
  const GhostTile b = mixed_tile(0.5f, 0, 9);
  EXPECT_EQ(a.candidates, b.candidates);
  EXPECT_EQ(a.graph, b.graph);
}

TEST(Create, WidensOffsetsWhereObjectsReachBeyondTheNextTileAndRefusesFarther) {
  CreateOptions options;
  options.side_m = 0.1f;
  options.spreads = {spread_of(10)};
  options.spreads[0].least_scale = options.spreads[0].most_scale = 1;
  EXPECT_GT(create({twig(0.3f, 0.01f, 15)}, options).graph.reach, 1);
  options.side_m = 0.05f;
  try {
    create({twig(0.3f, 0.01f, 15)}, options);
    FAIL();
  } catch (const silvasim::base::Error& error) {
    EXPECT_NE(std::string(error.what()).find("too small for its objects"), std::string::npos) << error.what();
  }
}

TEST(Create, ThresholdOnlyEverAddsOrTakesArcsAway) {
  const auto arcs_at = [](float delta_m) { return mixed_tile(0.5f, delta_m, 11).graph.arcs(); };
  EXPECT_LT(arcs_at(-0.01f), arcs_at(0));
  EXPECT_LT(arcs_at(0), arcs_at(0.01f));
  EXPECT_EQ(arcs_at(-1), 0u);
}

}  // namespace
}  // namespace ghosttile::tile
