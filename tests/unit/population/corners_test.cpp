// Pruning at the tiling's vertices, against brute force over all plants of the land.
#include "silvasim/population/corners.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "silvasim/base/error.h"
#include "silvasim/base/parallel.h"

namespace silvasim::population {
namespace {

using config::CornerSolver;
using ecosystem::no_plant;
using ecosystem::PlantId;
using Random = std::mt19937_64;

std::uint64_t below(Random& random, std::uint64_t bound) { return random() % bound; }
double share(Random& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

// A land whose sites crowd at the tiles' corners, so that every vertex is a problem. Pruning does not ask for colours.
struct Land {
  tiles::TileSet set;
  tiles::Tiling tiling;
  std::vector<std::uint64_t> offsets;
  std::vector<PlantId> plants;
  std::vector<float> probability;
};

struct LandOptions {
  int columns = 6, rows = 5;
  std::size_t tiles = 7;
  std::size_t sites_a_corner = 12;
  double most_radius_m = 8;
  double least_share = 0.25;  // least radius / most radius
  double planted = 0.8;       // share of the sites with a plant
};

Land random_land(Random& random, const LandOptions& options = {}) {
  Land land;
  const double most = options.most_radius_m, side = 13.5 * most;
  land.set.side_m = side;
  land.set.most_radius_m = most;
  for (std::size_t t = 0; t < options.tiles; ++t) {
    tiles::Tile tile;
    for (int corner = 0; corner < 4; ++corner) {
      for (std::size_t i = 0; i < options.sites_a_corner; ++i) {
        // Just inside of 4 Rmax along each axis, most of them closer.
        const double x = 3.99 * most * share(random) * share(random), y = 3.99 * most * share(random) * share(random);
        tile.sites.push_back(
            {static_cast<float>(corner % 2 ? side - 0.001 * most - x : x),
             static_cast<float>(corner / 2 ? side - 0.001 * most - y : y),
             static_cast<float>(most * (options.least_share + (1 - options.least_share) * share(random)))});
      }
    }
    // One site in the middle, which nobody may touch.
    tile.sites.push_back({static_cast<float>(side / 2), static_cast<float>(side / 2), static_cast<float>(most)});
    std::sort(tile.sites.begin(), tile.sites.end(), [](const tiles::Site& a, const tiles::Site& b) {
      return std::pair(a.y_m, a.x_m) < std::pair(b.y_m, b.x_m);
    });
    land.set.tiles.push_back(tile);
  }
  land.tiling.columns = options.columns;
  land.tiling.rows = options.rows;
  for (int i = 0; i < options.columns * options.rows; ++i) {
    land.tiling.tiles.push_back(static_cast<std::uint16_t>(below(random, options.tiles)));
  }
  land.offsets = ecosystem::site_offsets(land.set, land.tiling);
  for (std::uint64_t i = 0; i < land.offsets.back(); ++i) {
    land.plants.push_back(share(random) < options.planted ? static_cast<PlantId>(below(random, 5)) : no_plant);
    land.probability.push_back(static_cast<float>(share(random)));
  }
  return land;
}

CornerReport prune(Land& land, CornerSolver solver) {
  return prune_corners(land.set, land.tiling, land.offsets, land.plants, land.probability, solver);
}

// Every site of the land in scene coordinates, and every overlapping pair of standing plants.
struct Disc {
  double x, y, radius;
};

std::vector<Disc> discs_of(const Land& land) {
  std::vector<Disc> discs;
  for (int row = 0; row < land.tiling.rows; ++row) {
    for (int column = 0; column < land.tiling.columns; ++column) {
      for (const tiles::Site& site : land.set.tiles[land.tiling.at(column, row)].sites) {
        discs.push_back({column * land.set.side_m + static_cast<double>(site.x_m),
                         (land.tiling.rows - 1 - row) * land.set.side_m + static_cast<double>(site.y_m),
                         static_cast<double>(site.radius_m)});
      }
    }
  }
  return discs;
}

std::vector<std::pair<std::size_t, std::size_t>> conflicts_of(const Land& land, const std::vector<PlantId>& plants) {
  const std::vector<Disc> discs = discs_of(land);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t a = 0; a < discs.size(); ++a) {
    if (plants[a] == no_plant) continue;
    for (std::size_t b = a + 1; b < discs.size(); ++b) {
      if (plants[b] == no_plant) continue;
      const double x = discs[a].x - discs[b].x, y = discs[a].y - discs[b].y, reach = discs[a].radius + discs[b].radius;
      if (x * x + y * y < reach * reach) pairs.push_back({a, b});
    }
  }
  return pairs;
}

class CornersTest : public testing::TestWithParam<CornerSolver> {};
INSTANTIATE_TEST_SUITE_P(Solvers, CornersTest, testing::Values(CornerSolver::optimal, CornerSolver::paper),
                         [](const auto& solver) {
                           return solver.param == CornerSolver::optimal ? "optimal" : "paper";
                         });

TEST_P(CornersTest, NothingOverlapsAfterwardsAndNothingWentForNothing) {
  const std::uint64_t seed = 441;
  SCOPED_TRACE("seed " + std::to_string(seed));
  Random random(seed);
  for (int round = 0; round < 12; ++round) {
    Land land = random_land(random, {.sites_a_corner = 3 + below(random, 12), .planted = 0.3 + 0.7 * share(random)});
    const std::vector<PlantId> before = land.plants;
    const auto conflicts = conflicts_of(land, before);
    const CornerReport report = prune(land, GetParam());

    ASSERT_TRUE(conflicts_of(land, land.plants).empty()) << "round " << round;
    std::uint64_t removed = 0;
    std::vector<bool> rival_stands(before.size(), false);
    for (const auto& [a, b] : conflicts) {
      if (land.plants[b] != no_plant) rival_stands[a] = true;
      if (land.plants[a] != no_plant) rival_stands[b] = true;
    }
    for (std::size_t i = 0; i < before.size(); ++i) {
      if (land.plants[i] == before[i]) continue;
      ASSERT_EQ(land.plants[i], no_plant);
      ASSERT_TRUE(rival_stands[i]) << "round " << round << ": plant " << i << " gave way to nobody";
      ++removed;
    }
    ASSERT_GT(removed, 0u);
    EXPECT_EQ(report.removed, removed);
  }
}

TEST_P(CornersTest, ReportsWhatBruteForceFinds) {
  Random random(442);
  Land land = random_land(random, {.sites_a_corner = 6});
  const std::vector<PlantId> before = land.plants;
  const auto conflicts = conflicts_of(land, before);
  const CornerReport report = prune(land, GetParam());

  std::vector<std::size_t> group(before.size());
  std::iota(group.begin(), group.end(), std::size_t{0});
  // Spread the lowest number through each group until nothing changes.
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& [a, b] : conflicts) {
      const std::size_t low = std::min(group[a], group[b]);
      changed |= group[a] != low || group[b] != low;
      group[a] = group[b] = low;
    }
  }
  const std::vector<Disc> discs = discs_of(land);
  std::map<std::size_t, std::uint64_t> sizes;
  std::vector<bool> seen(before.size(), false);
  double weight = 0, kept_weight = 0;
  for (const auto& [a, b] : conflicts) {
    for (const std::size_t i : {a, b}) {
      if (seen[i]) continue;
      seen[i] = true;
      ++sizes[group[i]];
      const double w = static_cast<double>(land.probability[i]) * discs[i].radius / land.set.most_radius_m;
      weight += w;
      if (land.plants[i] != no_plant) kept_weight += w;
    }
  }
  std::uint64_t largest = 0;
  for (const auto& [first, size] : sizes) largest = std::max(largest, size);
  EXPECT_EQ(report.conflicts, conflicts.size());
  EXPECT_EQ(report.components, sizes.size());
  EXPECT_EQ(report.largest, largest);
  EXPECT_EQ(report.fallbacks, 0u);
  EXPECT_NEAR(report.weight, weight, 1e-6);
  EXPECT_NEAR(report.kept_weight, kept_weight, 1e-6);
}

// D1: only the radius' share of Rmax counts, so metres or millimetres make no difference.
TEST_P(CornersTest, ScalingAllLengthsChangesNothing) {
  for (const double factor : {0.125, 4.0, 1024.0}) {
    Random random(443);
    Land land = random_land(random);
    Land scaled = land;
    scaled.set.side_m *= factor;
    scaled.set.most_radius_m *= factor;
    for (tiles::Tile& tile : scaled.set.tiles) {
      for (tiles::Site& site : tile.sites) {
        for (float* length : {&site.x_m, &site.y_m, &site.radius_m}) *length *= static_cast<float>(factor);
      }
    }
    EXPECT_EQ(prune(land, GetParam()), prune(scaled, GetParam())) << factor;
    EXPECT_EQ(land.plants, scaled.plants) << factor;
  }
}

TEST_P(CornersTest, SameBytesWithAnyNumberOfThreads) {
  Random random(444);
  const Land land = random_land(random, {.columns = 23, .rows = 140});
  Land one = land;
  CornerReport report;
  {
    const base::ThreadLimit limit(1);
    report = prune(one, GetParam());
  }
  for (const int threads : {2, 3, 8}) {
    const base::ThreadLimit limit(threads);
    Land many = land;
    EXPECT_EQ(prune(many, GetParam()), report) << threads;
    EXPECT_EQ(many.plants, one.plants) << threads;
  }
}

// More tiles than the table of overlaps takes: the search at each vertex must find the same.
TEST_P(CornersTest, LargeTileSetsGiveTheSame) {
  Random random(445);
  Land land = random_land(random);
  Land padded = land;
  padded.set.tiles.resize(300, land.set.tiles[0]);
  EXPECT_EQ(prune(land, GetParam()), prune(padded, GetParam()));
  EXPECT_EQ(land.plants, padded.plants);
}

// D4: a site without a plant is no rival.
TEST_P(CornersTest, SitesWithoutPlantsLeaveFirst) {
  Random random(446);
  Land land = random_land(random);
  for (const auto& [a, b] : conflicts_of(land, land.plants)) {
    if (land.plants[a] != no_plant) land.plants[b] = no_plant;
  }
  const std::vector<PlantId> before = land.plants;
  EXPECT_EQ(prune(land, GetParam()), CornerReport{});
  EXPECT_EQ(land.plants, before);
}

TEST_P(CornersTest, TheBorderOfTheLandHasVerticesToo) {
  Random random(447);
  for (const auto& [columns, rows] : {std::pair(1, 1), std::pair(1, 7), std::pair(7, 1), std::pair(0, 0)}) {
    Land land = random_land(random, {.columns = columns, .rows = rows});
    const auto conflicts = conflicts_of(land, land.plants);
    EXPECT_EQ(prune(land, GetParam()).conflicts, conflicts.size()) << columns << " x " << rows;
    EXPECT_TRUE(conflicts_of(land, land.plants).empty()) << columns << " x " << rows;
  }
}

TEST_P(CornersTest, SmallTilesAreRefused) {
  Random random(448);
  Land land = random_land(random);
  land.set.side_m = 8 * land.set.most_radius_m;
  EXPECT_THAT([&] { prune(land, GetParam()); },
              testing::ThrowsMessage<base::Error>(testing::HasSubstr("larger than 8 times")));
}

TEST_P(CornersTest, StopsWhenTold) {
  Random random(449);
  Land land = random_land(random);
  EXPECT_THROW(prune_corners(land.set, land.tiling, land.offsets, land.plants, land.probability, GetParam(),
                             [](std::string_view, double) { return false; }),
               base::Cancelled);
}

TEST(Corners, TheLikelierAndLargerPlantStays) {
  Land land;
  land.set.side_m = 100;
  land.set.most_radius_m = 10;
  land.set.tiles = {{{}, {{95, 50, 4}, {95, 1, 4}}}, {{}, {{1, 2, 8}, {5, 50, 4}}}};
  land.tiling = {2, 1, {0, 1}};
  land.offsets = ecosystem::site_offsets(land.set, land.tiling);
  // Site 1 of the western tile and site 0 of the eastern one overlap at the southern vertex.
  for (const CornerSolver solver : {CornerSolver::optimal, CornerSolver::paper}) {
    land.plants = {0, 1, 2, 3};
    land.probability = {1, 0.5f, 0.3f, 1};  // weights 0.2 and 0.24
    EXPECT_EQ(prune(land, solver).conflicts, 1u);
    EXPECT_THAT(land.plants, testing::ElementsAre(0, no_plant, 2, 3));
    land.plants = {0, 1, 2, 3};
    land.probability = {1, 0.7f, 0.3f, 1};  // weights 0.28 and 0.24
    prune(land, solver);
    EXPECT_THAT(land.plants, testing::ElementsAre(0, 1, no_plant, 3));
    land.plants = {0, 1, 2, 3};
    land.probability = {1, 0, 0, 1};  // of equals the lower site
    prune(land, solver);
    EXPECT_THAT(land.plants, testing::ElementsAre(0, 1, no_plant, 3));
  }
}

TEST(Corners, CrowdsTooLargeForTheExactSolverAreReported) {
  Random random(450);
  Land land = random_land(random, {.sites_a_corner = 40, .planted = 1});
  const CornerReport report = prune(land, CornerSolver::optimal);
  EXPECT_GT(report.largest, 64u);
  EXPECT_GT(report.fallbacks, 0u);
  EXPECT_TRUE(conflicts_of(land, land.plants).empty());
}

TEST(Corners, TheOptimumIsNoWorseThanThePaper) {
  Random random(451);
  double best = 0, paper = 0;
  for (int round = 0; round < 20; ++round) {
    Land land = random_land(random, {.sites_a_corner = 4}), other = land;
    const CornerReport optimal = prune(land, CornerSolver::optimal), heuristic = prune(other, CornerSolver::paper);
    EXPECT_GE(optimal.kept_weight, heuristic.kept_weight);
    EXPECT_EQ(optimal.fallbacks, 0u);
    best += optimal.kept_weight;
    paper += heuristic.kept_weight;
  }
  std::cout << "share of the optimum: paper " << paper / best << '\n';
  EXPECT_GT(paper / best, 0.9);
}

}  // namespace
}  // namespace silvasim::population
