// Maps of suitability against a plain loop over the sites.
#include "silvasim/evaluators/suitability_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "silvasim/base/parallel.h"
#include "tests/unit/evaluators/scene.h"

namespace silvasim::evaluators {
namespace {

const char* const plants =
    "<plant name=\"one\"><property name=\"A\"><MinMax min=\"0.3\" max=\"0.9\"/></property></plant>"
    "<plant name=\"two\"><scale least=\"0.8\" most=\"1.4\"/><property name=\"A\"><Table><point x=\"0\" y=\"1\"/>"
    "<point x=\"1\" y=\"0\"/></Table></property></plant>";
const std::string pipeline =
    "<pipeline><RadiusEvaluator/><FunctionEvaluator lethal=\"true\"><datafield>a</datafield><property>A</property>"
    "</FunctionEvaluator></pipeline>";

double wave(double x, double y) { return 0.5 + 0.5 * std::sin(x / 37) * std::cos(y / 53); }

Scene scene_of(double side, const std::string& tile_side = "80 m") {
  return make_scene("<tiles side=\"" + tile_side + "\"><radii least=\"2 m\" most=\"6 m\"/></tiles>" + pipeline, plants,
                    {wave}, side);
}

TEST(SuitabilityMap, HoldsTheMeanOfEachCellsSites) {
  // A whole number of tiles, and one that the tiles overlap by more than a cell.
  for (const double side : {400.0, 333.0}) {
    const Scene scene = scene_of(side);
    const Ground ground = scene.ground();
    const Suitability suitability = evaluate_sites(Network(scene.scenario, 0), ground);
    const ecosystem::SuitabilityMap map = map_suitability(suitability, ground);
    ASSERT_EQ(map.west, 0);
    ASSERT_EQ(map.north, side);
    ASSERT_GE(map.columns * map.cell_m, side - 1e-6);
    ASSERT_LT((map.columns - 1) * map.cell_m, side);
    ASSERT_EQ(map.columns, map.rows);

    struct Sum {
      double shares[2] = {0, 0};
      int sites = 0;
    };
    std::map<std::pair<int, int>, Sum> sums;
    std::size_t index = 0;
    for (int row = 0; row < scene.tiling.rows; ++row) {
      for (int column = 0; column < scene.tiling.columns; ++column) {
        for (const tiles::Site& site : scene.tile_set.tiles[scene.tiling.at(column, row)].sites) {
          const double x = column * 80 + static_cast<double>(site.x_m);
          const double y = side - (row + 1) * 80 + static_cast<double>(site.y_m);
          const float* const p = suitability.probability.data() + 2 * index++;
          if (x < 0 || x > side || y < 0 || y > side) continue;
          Sum& sum = sums[{static_cast<int>(x / map.cell_m), static_cast<int>((side - y) / map.cell_m)}];
          ++sum.sites;
          for (int s = 0; s < 2; ++s) sum.shares[s] += p[s] == excluded ? 0.0 : static_cast<double>(p[s]);
        }
      }
    }
    ASSERT_EQ(index * 2, suitability.probability.size());
    int between = 0;
    for (int row = 0; row < map.rows; ++row) {
      for (int column = 0; column < map.columns; ++column) {
        const auto found = sums.find({column, row});
        for (int s = 0; s < 2; ++s) {
          const int share = map.of(static_cast<std::size_t>(s))[row * map.columns + column];
          if (found == sums.end()) {
            ASSERT_EQ(share, ecosystem::SuitabilityMap::no_site);
          } else {
            ASSERT_NEAR(share, 254 * found->second.shares[s] / found->second.sites, 0.501);
            between += share > 0 && share < 254;
          }
        }
      }
    }
    EXPECT_GT(between, 200);
    // Few cells are without sites.
    EXPECT_GT(static_cast<double>(sums.size()), 0.9 * map.columns * map.rows);
  }
}

TEST(SuitabilityMap, CellsHoldThreeSitesOrAreAThousandAcross) {
  const Scene scene = scene_of(400);
  Suitability suitability = evaluate_sites(Network(scene.scenario, 0), scene.ground());
  const double mean_cell = std::sqrt(3 * 400.0 * 400.0 / static_cast<double>(suitability.inside));
  const double cell = map_suitability(suitability, scene.ground()).cell_m;
  EXPECT_GE(cell, mean_cell);
  EXPECT_LT(cell, 1.11 * mean_cell);
  EXPECT_NEAR(cell * 10, std::round(cell * 10), 1e-9) << "two digits";
  // More sites than a map can show apart, and none.
  suitability.inside = std::uint64_t{1} << 40;
  const ecosystem::SuitabilityMap fine = map_suitability(suitability, scene.ground());
  EXPECT_EQ(fine.columns, 1000);
  EXPECT_EQ(fine.rows, 1000);
  suitability.inside = 0;
  EXPECT_EQ(map_suitability(suitability, scene.ground()).shares.size(), 2u);
}

TEST(SuitabilityMap, SameBytesWithAnyNumberOfThreads) {
  const Scene scene = scene_of(1600);
  const Suitability suitability = evaluate_sites(Network(scene.scenario, 0), scene.ground());
  ecosystem::SuitabilityMap first;
  for (const int threads : {1, 2, 3, 8}) {
    const base::ThreadLimit limit(threads);
    const ecosystem::SuitabilityMap map = map_suitability(suitability, scene.ground());
    if (first.empty()) first = map;
    EXPECT_TRUE(map == first) << threads << " threads";
  }
}

}  // namespace
}  // namespace silvasim::evaluators
