// The order of Algorithm 2: against the plain way on small lands, and by hand on single cells. docs/reading.md, C1 to C5.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "tests/unit/population/grown.h"
#include "tests/unit/population/plain_algorithm_2.h"

namespace silvasim::population {
namespace {

using ecosystem::no_plant;
using ecosystem::PlantId;
using testing::ElementsAre;

const std::string unlike = plant("one", 0.2, 3, 12) + plant("two", 0.5, 4, 14) + plant("three", 0.8, 5, 16);

// Influences of both signs: some probabilities reach 1.
const std::string mixed =
    "<neighbourhoods fmin=\"0.2\"><influence from=\"*\" on=\"*\" value=\"-0.2\"/>"
    "<influence from=\"one\" on=\"two\" value=\"0.6\"/><influence from=\"two\" on=\"three\" value=\"-1.5\"/>"
    "<influence from=\"three\" on=\"one\" value=\"0.3\"/></neighbourhoods>";

// The fields change from site to site, so that many sites are undecided between two species.
double fine_waves(double x, double y) { return 0.5 + 0.5 * std::sin(x / 7) * std::cos(y / 5); }
double fine_bumps(double x, double y) { return 0.5 + 0.5 * std::cos(x / 4 + y / 6); }
const evaluators::FieldFunctions fine = {fine_waves, fine_bumps};

const std::vector<std::string> establishments = {certain, "<establishment chance=\"stochastic\"/>",
                                                 "<establishment selection=\"weighted\" chance=\"stochastic\"/>"};

// Runs the engine for 1, 2 and 3 passes and compares each with the plain way.
void compare_with_the_plain_way(Grown grown, std::uint64_t seed, const NeighbourhoodOptions& options) {
  const evaluators::Ground ground = grown.scene.ground();
  PlainAlgorithm2 plain(grown.suitability, ground, grown.layer(), seed);
  std::vector<std::uint64_t> changed;
  for (int passes = 1; passes <= 3; ++passes) {
    SCOPED_TRACE(std::to_string(passes) + " passes");
    grown.scene.scenario.layers[0].neighbourhoods.passes = passes;
    const Competition engine = grown.compete(seed, options);
    changed.push_back(plain.pass(engine.report.cell_m, engine.report.block_tiles));
    ASSERT_EQ(engine.report.changed, changed);
    ASSERT_EQ(engine.population.plants, plain.plants);
    ASSERT_EQ(engine.population.candidates, plain.candidates);
    for (std::size_t i = 0; i < plain.probability.size(); ++i) {
      ASSERT_NEAR(static_cast<double>(engine.population.probability[i]), plain.probability[i],
                  1e-5 * plain.probability[i])
          << "site " << i;
    }
  }
  // Else the comparison says little: neighbours must change plants, in the second pass too.
  const Population alone = establish(grown.suitability, ground, grown.layer(), seed);
  std::size_t unlike_alone = 0;
  for (std::size_t i = 0; i < plain.plants.size(); ++i) unlike_alone += plain.plants[i] != alone.plants[i];
  EXPECT_GT(unlike_alone, plain.plants.size() / 20);
  EXPECT_GT(changed[1], plain.plants.size() / 50);
}

TEST(Algorithm2, OneBlockEqualsThePlainWay) {
  for (const std::string& establishment : establishments) {
    for (const std::string& neighbourhoods : {rivalry(0.9, ""), mixed}) {
      const Grown grown = grow(neighbourhoods, unlike, 160, establishment, fine);
      for (const std::uint64_t seed : {1, 2, 3}) {
        SCOPED_TRACE(establishment + neighbourhoods + " seed " + std::to_string(seed));
        compare_with_the_plain_way(grown, seed, {.one_block = true});
      }
    }
  }
}

// C5: a block is weighed with the plants around it as they stand when it starts. Here each tile is a block.
TEST(Algorithm2, ManyBlocksEqualThePlainWay) {
  for (const std::string& establishment : establishments) {
    const Grown grown = grow(rivalry(0.9, "cell=\"3.6 m\""), unlike, 240, establishment, fine);
    ASSERT_EQ(grown.compete(1).report.block_tiles, 1);
    for (const std::uint64_t seed : {1, 2}) {
      SCOPED_TRACE(establishment + " seed " + std::to_string(seed));
      compare_with_the_plain_way(grown, seed, {});
    }
  }
}

// A few sites in one cell, two species with the given probabilities, so that chance has no say in the order.
struct Cell {
  evaluators::Suitability suitability;
  tiles::TileSet tile_set;
  tiles::Tiling tiling{1, 1, {0}};
  std::vector<std::uint64_t> offsets;
  fields::FieldSet fields;
  config::LayerSettings layer;

  Cell(const std::vector<std::pair<float, float>>& sites, const std::vector<double>& influences) {
    suitability.species = 2;
    tile_set = {20, 4, 1, 1, {{}}};
    layer.chance = config::Chance::certain;
    layer.species.resize(2);
    layer.neighbourhoods = {true, 20, 1, 0.1, influences};
    for (std::size_t i = 0; i < sites.size(); ++i) {
      // All distances differ, and all are within the reach of 8 m.
      tile_set.tiles[0].sites.push_back({std::array{5.f, 6.f, 8.f, 12.f}.at(i), 10, 4});
      suitability.probability.insert(suitability.probability.end(), {sites[i].first, sites[i].second});
    }
    offsets = {0, sites.size()};
  }

  Population compete() const {
    return population::compete(suitability, {tile_set, tiling, {}, offsets, fields}, layer, 1).population;
  }
};

const std::vector<double> faint(4, -0.01);

// The order in which the sites of a cell were fixed, as their probabilities tell it: each was weighed with the plants
// fixed before it, and with no other. Empty if no order explains them.
std::vector<std::size_t> order_of_fixing(const std::vector<std::pair<float, float>>& sites,
                                         const std::vector<double>& influences = faint) {
  const Cell cell(sites, influences);
  const Population result = cell.compete();
  const auto& places = cell.tile_set.tiles[0].sites;
  std::vector<std::size_t> order(sites.size());
  std::iota(order.begin(), order.end(), 0);
  do {
    bool explains = true;
    for (std::size_t n = 0; n < order.size() && explains; ++n) {
      const std::size_t i = order[n], species = result.plants[i];
      if (species == no_plant) return {};
      auto expected = static_cast<double>(cell.suitability.probability[i * 2 + species]);
      for (std::size_t m = 0; m < n; ++m) {
        const std::size_t k = order[m], from = result.plants[k];
        const double d = std::abs(static_cast<double>(places[i].x_m - places[k].x_m));
        expected *= 1 + influences[from * 2 + species] * plain_field(cell.layer.species[from], 0.1, 4, d);
      }
      explains = std::abs(static_cast<double>(result.probability[i]) - expected) < 1e-6;
    }
    if (explains) return order;
  } while (std::next_permutation(order.begin(), order.end()));
  return {};
}

constexpr float excluded = evaluators::excluded;

// C2: "certainty" is what the best species has over the second best, not what it has.
TEST(Algorithm2, TheMostCertainSiteIsFixedFirst) {
  EXPECT_THAT(order_of_fixing({{0.8f, 0.7f}, {0.6f, 0.1f}}), ElementsAre(1, 0));
  EXPECT_THAT(order_of_fixing({{0.1f, 0.6f}, {0.8f, 0.7f}}), ElementsAre(0, 1));
  EXPECT_THAT(order_of_fixing({{0.5f, 0.4f}, {0.6f, 0.3f}, {0.2f, 0.9f}, {0.9f, 0.7f}}), ElementsAre(2, 1, 3, 0));
}

TEST(Algorithm2, TheMostCertainSiteDecidesAboutItsNeighbour) {
  // The second site's plant presses the other species out of the first, where that would have been the better one.
  const Population result = Cell({{0.7f, 0.8f}, {0.6f, 0.1f}}, {0, -0.9, -0.9, 0}).compete();
  EXPECT_THAT(result.plants, ElementsAre(0, 0));
}

TEST(Algorithm2, WithoutASecondSpeciesCertaintyIsTheBest) {
  for (const float none : {0.0f, excluded}) {
    EXPECT_THAT(order_of_fixing({{0.3f, none}, {0.5f, 0.1f}}), ElementsAre(1, 0));
    EXPECT_THAT(order_of_fixing({{none, 0.5f}, {0.5f, 0.1f}}), ElementsAre(0, 1));
  }
}

TEST(Algorithm2, OfEqualsTheFirstSiteAndTheFirstSpeciesWin) {
  EXPECT_THAT(order_of_fixing({{0.5f, 0.25f}, {0.75f, 0.5f}}), ElementsAre(0, 1));
  EXPECT_THAT(order_of_fixing({{0.75f, 0.5f}, {0.25f, 0.5f}}), ElementsAre(0, 1));
  EXPECT_THAT(Cell({{0.5f, 0.5f}}, faint).compete().plants, ElementsAre(0));
}

// C3: a plant's influence reaches the certainty of its neighbours, and so the order.
TEST(Algorithm2, CertaintyFollowsTheNeighbours) {
  const std::vector<std::pair<float, float>> sites = {{0.9f, 0}, {0.6f, 0}, {0, 0.4f}};
  EXPECT_THAT(order_of_fixing(sites), ElementsAre(0, 1, 2));
  EXPECT_THAT(order_of_fixing(sites, {-0.9, -0.01, -0.01, -0.01}), ElementsAre(0, 2, 1));
}

TEST(Algorithm2, ASiteWithoutAViableSpeciesStaysBareAndActsOnNone) {
  for (const auto& bare : {std::pair(0.0f, 0.0f), {excluded, excluded}, {excluded, 0.0f}}) {
    const Population result = Cell({bare, {0.25f, 0.5f}}, {-1, -1, -1, -1}).compete();
    EXPECT_THAT(result.plants, ElementsAre(no_plant, 1));
    EXPECT_THAT(result.probability, ElementsAre(0.0f, 0.5f));
  }
}

}  // namespace
}  // namespace silvasim::population
