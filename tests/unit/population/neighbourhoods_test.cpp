// The field-of-neighbourhood passes, by the invariants of docs/reading.md, section C.
#include "silvasim/population/neighbourhoods.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>

#include "silvasim/base/parallel.h"
#include "silvasim/population/influence_field.h"
#include "tests/unit/population/grown.h"
#include "tests/unit/population/plain_algorithm_2.h"

namespace silvasim::population {
namespace {

using ecosystem::no_plant;
using ecosystem::PlantId;

constexpr std::uint64_t seed = 11;

double share_equal(const std::vector<PlantId>& a, const std::vector<PlantId>& b) {
  std::size_t equal = 0;
  for (std::size_t i = 0; i < a.size(); ++i) equal += a[i] == b[i];
  return static_cast<double>(equal) / static_cast<double>(a.size());
}

// C1.
TEST(Neighbourhoods, EverySiteIsFixedOnceAPass) {
  const Grown grown = grow(rivalry(0.4, "passes=\"3\""));
  const Competition result = grown.compete(seed);
  EXPECT_EQ(result.report.fixings, grown.scene.offsets.back() * static_cast<std::uint64_t>(result.report.passes));
  for (const PlantId plant : result.population.plants) EXPECT_NE(plant, no_plant);
}

// C3: without influence the abiotic choice, by chance and by draw too.
TEST(Neighbourhoods, NoInfluenceGivesTheAbioticChoice) {
  for (const char* establishment : {"<establishment chance=\"certain\"/>", "<establishment chance=\"stochastic\"/>",
                                    "<establishment selection=\"weighted\" chance=\"stochastic\"/>"}) {
    const Grown grown = grow(influences(0, "passes=\"2\""), three, 400, establishment);
    const Population alone = establish(grown.suitability, grown.scene.ground(), grown.layer(), seed);
    const Competition result = grown.compete(seed);
    EXPECT_EQ(result.population.plants, alone.plants);
    EXPECT_EQ(result.population.candidates, alone.candidates);
    EXPECT_EQ(result.population.probability, alone.probability);
    EXPECT_EQ(result.report.passes, 2);
    EXPECT_EQ(result.report.changed.back(), 0u);
  }
}

TEST(Neighbourhoods, ProbabilitiesStayWithinBounds) {
  for (const double value : {-5.0, -0.5, 0.5, 5.0}) {
    const Competition result = grow(influences(value, "passes=\"2\""), three, 400).compete(seed);
    for (const float p : result.population.probability) ASSERT_TRUE(p >= 0 && p <= 1) << p;
  }
}

TEST(Neighbourhoods, ExcludedSpeciesStayExcluded) {
  const std::string lethal =
      "<pipeline><MinMaxEvaluator "
      "lethal=\"true\"><datafield>a</datafield><property>A</property></MinMaxEvaluator></pipeline>";
  const std::string two =
      "<plant name=\"low\"><property name=\"A\"><MinMax min=\"0\" max=\"0.5\"/></property></plant>"
      "<plant name=\"high\"><property name=\"A\"><MinMax min=\"0.5\" max=\"0.9\"/></property></plant>";
  Grown grown{evaluators::make_scene(
                  tiles_element + lethal + "<establishment chance=\"certain\"/>" + influences(5, "passes=\"2\""), two,
                  {wave, bumps}, 400),
              {}};
  grown.suitability = evaluators::evaluate_sites(evaluators::Network(grown.scene.scenario, 0), grown.scene.ground());
  const Competition result = grown.compete(seed);
  std::size_t bare = 0;
  for (std::size_t i = 0; i < result.population.plants.size(); ++i) {
    const PlantId plant = result.population.plants[i];
    if (plant == no_plant) {
      ++bare;
    } else {
      EXPECT_GT(grown.suitability.probability[i * 2 + plant], 0);
    }
  }
  EXPECT_GT(bare, 0u);
}

// C5: same bytes with any number of threads.
TEST(Neighbourhoods, SameBytesWithAnyNumberOfThreads) {
  const Grown grown = grow(rivalry(0.9, "passes=\"2\" cell=\"4 m\""), three, 1200, "<establishment/>");
  std::optional<Population> first;
  for (int threads : {1, 2, 3, 8}) {
    const base::ThreadLimit limit(threads);
    const Competition result = grown.compete(seed);
    if (!first) first = result.population;
    EXPECT_EQ(result.population.plants, first->plants) << threads << " threads";
    EXPECT_EQ(result.population.candidates, first->candidates) << threads << " threads";
    EXPECT_EQ(result.population.probability, first->probability) << threads << " threads";
    const int blocks_across = (grown.scene.tiling.columns + result.report.block_tiles - 1) / result.report.block_tiles;
    ASSERT_GE(blocks_across, 8) << "each of the four colours needs many blocks, or nothing runs in parallel";
  }
}

// C5: blocks agree with the sequential algorithm as two sequential seeds agree with each other.
TEST(Neighbourhoods, BlocksAgreeWithTheSequentialAlgorithm) {
  const Grown grown = grow(rivalry(0.4, "passes=\"1\" cell=\"12 m\""), three, 4000);
  const Competition blocks = grown.compete(seed);
  ASSERT_LT(blocks.report.block_tiles * tile_m, 1000) << "the land must hold many blocks for this to say anything";
  const Competition sequential = grown.compete(seed, {.one_block = true}),
                    other = grown.compete(seed + 1, {.one_block = true});
  const double with_blocks = share_equal(blocks.population.plants, sequential.population.plants);
  const double among_seeds = share_equal(other.population.plants, sequential.population.plants);
  std::cout << "agreement of blocks with sequential " << with_blocks << ", of two sequential seeds " << among_seeds
            << "\n";
  EXPECT_LT(std::abs(with_blocks - among_seeds), 0.005);
  EXPECT_LT(among_seeds, 0.9999) << "the influences are too weak for this to say anything";

  double distance = 0;
  for (PlantId s = 0; s < 3; ++s) {
    const auto count = [&](const Competition& c) {
      return std::count(c.population.plants.begin(), c.population.plants.end(), s);
    };
    distance += std::abs(static_cast<double>(count(blocks) - count(sequential))) /
                static_cast<double>(blocks.population.plants.size());
  }
  EXPECT_LT(distance / 2, 0.002);
}

// C3: for one species, the weighed probability is the abiotic one times the closed form over the plants around it. With
// certain establishment and a second pass, every neighbour of a site stands: the product runs over all of them, on both
// sides of a seam between blocks.
TEST(Neighbourhoods, OneSpeciesEqualsTheClosedForm) {
  for (const bool one_block : {true, false}) {
    SCOPED_TRACE(one_block ? "one block" : "each tile a block");
    const Grown grown = grow(influences(-0.05, "passes=\"2\" cell=\"3.6 m\""), plant("only", 0.5), 400);
    const Competition result = grown.compete(seed, {.one_block = one_block});
    ASSERT_EQ(result.report.block_tiles, one_block ? 5 : 1);
    // One species: the second pass changes no plant, so all neighbours are as at its start.
    ASSERT_EQ(result.report.changed[1], 0u);
    const config::SpeciesSettings& species = grown.layer().species[0];
    const std::vector<PlainSite> sites = plain_sites(grown.scene.ground());
    for (std::size_t i = 0; i < sites.size(); ++i) {
      ASSERT_EQ(result.population.plants[i], 0);
      double expected = static_cast<double>(grown.suitability.probability[i]);
      for (std::size_t k = 0; k < sites.size(); ++k) {
        const double d = std::hypot(sites[k].x_m - sites[i].x_m, sites[k].y_m - sites[i].y_m);
        if (k != i) expected *= 1 - 0.05 * plain_field(species, 0.1, sites[k].radius_m, d);
      }
      ASSERT_NEAR(static_cast<double>(result.population.probability[i]), expected, 1e-5 * expected) << "site " << i;
    }
  }
}

TEST(Neighbourhoods, FieldIsOneAtTheStemAndFminAtTheRim) {
  const Grown grown =
      grow("<neighbourhoods fmin=\"0.2\"><influence from=\"*\" on=\"*\" value=\"-1\"/></neighbourhoods>", three, 160);
  const InfluenceField field = Influences(grown.layer()).field(0, 6);
  EXPECT_FLOAT_EQ(field.reach_m, 21);
  EXPECT_EQ(field.at(0), 1);
  EXPECT_EQ(field.at(0.3f), 1);
  EXPECT_NEAR(field.at(21), 0.2, 1e-6);
  EXPECT_EQ(field.at(21.01f), 0);
  EXPECT_GT(field.at(5), field.at(6));
}

// C3: listing the species in another order changes nothing but their numbers.
TEST(Neighbourhoods, TheOrderOfListingDoesNotMatter) {
  const std::string matrix =
      "<neighbourhoods passes=\"2\"><influence from=\"one\" on=\"two\" value=\"-0.5\"/><influence from=\"two\" "
      "on=\"three\" value=\"-0.3\"/>"
      "<influence from=\"three\" on=\"one\" value=\"-0.2\"/><influence from=\"two\" on=\"one\" "
      "value=\"0.2\"/></neighbourhoods>";
  const Competition a = grow(matrix, plant("one", 0.2) + plant("two", 0.5) + plant("three", 0.8)).compete(seed);
  const Competition b = grow(matrix, plant("three", 0.8) + plant("one", 0.2) + plant("two", 0.5)).compete(seed);
  const PlantId renamed[] = {1, 2, 0};
  for (std::size_t i = 0; i < a.population.plants.size(); ++i) {
    const PlantId plant = a.population.plants[i];
    ASSERT_EQ(b.population.plants[i], plant == no_plant ? no_plant : renamed[plant]);
  }
}

// C4: passes settle, and stop when nothing changes.
TEST(Neighbourhoods, PassesSettle) {
  const Competition result = grow(rivalry(0.2, "passes=\"20\"")).compete(seed);
  const auto& changed = result.report.changed;
  std::cout << "changed a pass:";
  for (const auto c : changed) std::cout << " " << c;
  std::cout << "\n";
  ASSERT_GE(changed.size(), 3u);
  EXPECT_LT(changed.back(), changed[1] / 4 + 1);
  EXPECT_TRUE(changed.size() == 20 || changed.back() == 0);
}

TEST(Neighbourhoods, ACellMayBeLargerThanATile) {
  const Grown grown = grow(
      "<neighbourhoods passes=\"1\" cell=\"200 m\"><influence from=\"*\" on=\"*\" value=\"-0.4\"/></neighbourhoods>",
      three, 800);
  const Competition result = grown.compete(seed);
  EXPECT_DOUBLE_EQ(result.report.cell_m, 240);
  EXPECT_EQ(result.report.fixings, grown.scene.offsets.back());
}

// Suppression thins: fewer plants stand where neighbours press harder.
TEST(Neighbourhoods, SuppressionThinsTheStand) {
  const auto standing = [](double value) {
    const Competition c =
        grow(influences(value, "passes=\"2\""), three, 800, "<establishment chance=\"stochastic\"/>").compete(seed);
    return std::count_if(c.population.plants.begin(), c.population.plants.end(),
                         [](PlantId p) { return p != no_plant; });
  };
  const auto none = standing(0), some = standing(-0.2), much = standing(-0.5);
  EXPECT_GT(none, some);
  EXPECT_GT(some, much);
}

}  // namespace
}  // namespace silvasim::population
