// The field-of-neighbourhood passes, by the invariants of docs/reading.md, section C.
#include "silvasim/population/neighbourhoods.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "silvasim/base/parallel.h"
#include "silvasim/population/choice.h"
#include "silvasim/population/influence_field.h"
#include "tests/unit/evaluators/scene.h"

namespace silvasim::population {
namespace {

using ecosystem::no_plant;
using ecosystem::PlantId;
using evaluators::Scene;

constexpr std::uint64_t seed = 11;

double wave(double x, double y) { return 0.5 + 0.5 * std::sin(x / 171) * std::cos(y / 253); }
double bumps(double x, double y) { return 0.5 + 0.5 * std::cos(x / 71 + y / 129); }

std::string plant(const std::string& name, double mean, const std::string& more = "") {
  return "<plant name=\"" + name + "\"><model radius=\"4 m\"/><neighbourhood radius=\"14 m\"/>" + more +
         "<property name=\"A\"><Gauss mean=\"" + std::to_string(mean) +
         "\" deviation=\"0.35\"/></property><property name=\"B\"><Gauss mean=\"" + std::to_string(1 - mean * 0.8) +
         "\" deviation=\"0.5\"/></property></plant>";
}

const std::string pipeline =
    "<pipeline><FunctionEvaluator><datafield>a</datafield><property>A</property></"
    "FunctionEvaluator><FunctionEvaluator><datafield>b</datafield>"
    "<property>B</property></FunctionEvaluator></pipeline>";
const std::string tiles = "<tiles side=\"80 m\"><radii least=\"2 m\" most=\"6 m\"/></tiles>";
const std::string three = plant("one", 0.2) + plant("two", 0.5) + plant("three", 0.8);

struct Grown {
  Scene scene;
  evaluators::Suitability suitability;

  const config::LayerSettings& layer() const { return scene.scenario.layers[0]; }
  Competition compete(const NeighbourhoodOptions& options = {}, std::uint64_t with = seed) const {
    return population::compete(suitability, scene.ground(), layer(), with, options);
  }
};

Grown grow(const std::string& neighbourhoods, const std::string& plants = three, double side = 1200,
           const std::string& establishment = "<establishment chance=\"certain\"/>") {
  Grown grown{evaluators::make_scene(tiles + pipeline + establishment + neighbourhoods, plants, {wave, bumps}, side),
              {}};
  grown.suitability = evaluators::evaluate_sites(evaluators::Network(grown.scene.scenario, 0), grown.scene.ground());
  return grown;
}

std::string influences(double value, int passes = 1, const std::string& more = "") {
  return "<neighbourhoods passes=\"" + std::to_string(passes) + "\"><influence from=\"*\" on=\"*\" value=\"" +
         std::to_string(value) + "\"/>" + more + "</neighbourhoods>";
}

double share_equal(const std::vector<PlantId>& a, const std::vector<PlantId>& b) {
  std::size_t equal = 0;
  for (std::size_t i = 0; i < a.size(); ++i) equal += a[i] == b[i];
  return static_cast<double>(equal) / static_cast<double>(a.size());
}

// Influences that differ between species, so that neighbours change who is best.
std::string rivalry(double strength, const std::string& attributes) {
  const char* const names[] = {"one", "two", "three"};
  std::string text = "<neighbourhoods " + attributes + ">";
  for (int from = 0; from < 3; ++from) {
    for (int on = 0; on < 3; ++on) {
      const double value = -strength * (from == on ? 0.2 : 1.0 - 0.3 * ((on - from + 3) % 3 == 1));
      text += std::string("<influence from=\"") + names[from] + "\" on=\"" + names[on] + "\" value=\"" +
              std::to_string(value) + "\"/>";
    }
  }
  return text + "</neighbourhoods>";
}

// C1.
TEST(Neighbourhoods, EverySiteIsFixedOnceAPass) {
  const Grown grown = grow(rivalry(0.4, "passes=\"3\""));
  const Competition result = grown.compete();
  EXPECT_EQ(result.report.fixings, grown.scene.offsets.back() * static_cast<std::uint64_t>(result.report.passes));
  for (const PlantId plant : result.population.plants) EXPECT_NE(plant, no_plant);
}

// C3: without influence the abiotic choice, by chance and by draw too.
TEST(Neighbourhoods, NoInfluenceGivesTheAbioticChoice) {
  for (const char* establishment : {"<establishment chance=\"certain\"/>", "<establishment chance=\"stochastic\"/>",
                                    "<establishment selection=\"weighted\" chance=\"stochastic\"/>"}) {
    const Grown grown = grow(influences(0, 2), three, 400, establishment);
    const Population alone = establish(grown.suitability, grown.scene.ground(), grown.layer(), seed);
    const Competition result = grown.compete();
    EXPECT_EQ(result.population.plants, alone.plants);
    EXPECT_EQ(result.population.candidates, alone.candidates);
    EXPECT_EQ(result.population.probability, alone.probability);
    EXPECT_EQ(result.report.passes, 2);
    EXPECT_EQ(result.report.changed.back(), 0u);
  }
}

TEST(Neighbourhoods, ProbabilitiesStayWithinBounds) {
  for (const double value : {-5.0, -0.5, 0.5, 5.0}) {
    const Competition result = grow(influences(value, 2), three, 400).compete();
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
  Grown grown{evaluators::make_scene(tiles + lethal + "<establishment chance=\"certain\"/>" + influences(5, 2), two,
                                     {wave, bumps}, 400),
              {}};
  grown.suitability = evaluators::evaluate_sites(evaluators::Network(grown.scene.scenario, 0), grown.scene.ground());
  const Competition result = grown.compete();
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
  const Grown grown = grow(rivalry(0.4, "passes=\"2\""), three, 1200, "<establishment chance=\"stochastic\"/>");
  std::optional<Population> first;
  for (int threads : {1, 2, 3, 8}) {
    const base::ThreadLimit limit(threads);
    const Competition result = grown.compete();
    if (!first) first = result.population;
    EXPECT_EQ(result.population.plants, first->plants) << threads << " threads";
    EXPECT_EQ(result.population.probability, first->probability) << threads << " threads";
  }
}

// C5: blocks agree with the sequential algorithm as two sequential seeds agree with each other.
TEST(Neighbourhoods, BlocksAgreeWithTheSequentialAlgorithm) {
  const Grown grown = grow(rivalry(0.4, "passes=\"1\" cell=\"12 m\""), three, 4000);
  const Competition blocks = grown.compete();
  ASSERT_LT(blocks.report.block_tiles * 80, 1000) << "the land must hold many blocks for this to say anything";
  const Competition sequential = grown.compete({.one_block = true}),
                    other = grown.compete({.one_block = true}, seed + 1);
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

// C3: for one species, the weighed probability is the abiotic one times the closed form over the plants fixed before.
// With certain establishment and a second pass, every neighbour of a site stands: the product runs over all of them.
TEST(Neighbourhoods, OneSpeciesEqualsTheClosedForm) {
  const Grown grown = grow(influences(-0.05, 2), plant("only", 0.5), 400);
  const Competition result = grown.compete();
  ASSERT_EQ(result.report.changed[1],
            0u);  // one species: the second pass changes no plant, so all neighbours are as at its start
  const Influences fields(grown.layer());
  const auto& scene = grown.scene;
  std::vector<double> x, y, r;
  for (int row = 0; row < scene.tiling.rows; ++row) {
    for (int column = 0; column < scene.tiling.columns; ++column) {
      for (const auto& site : scene.tile_set.tiles[scene.tiling.at(column, row)].sites) {
        x.push_back(column * 80.0 + static_cast<double>(site.x_m));
        y.push_back(-(row + 1) * 80.0 + static_cast<double>(site.y_m));
        r.push_back(static_cast<double>(site.radius_m));
      }
    }
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    double expected = static_cast<double>(grown.suitability.probability[i]);
    if (expected < 0) continue;
    for (std::size_t k = 0; k < x.size(); ++k) {
      if (k == i || result.population.plants[k] == no_plant) continue;
      const double scale = r[k] / 4, reach = 14 * scale, stem = 0.2 * scale, d = std::hypot(x[k] - x[i], y[k] - y[i]);
      if (d > reach) continue;
      const double c = -std::log(0.1) / (reach - stem);
      expected *= 1 - 0.05 * (d <= stem ? 1 : std::exp(-c * (d - stem)));
    }
    ASSERT_NEAR(static_cast<double>(result.population.probability[i]), expected, 2e-4 * expected + 1e-6)
        << "site " << i;
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
  const Competition a = grow(matrix, plant("one", 0.2) + plant("two", 0.5) + plant("three", 0.8)).compete();
  const Competition b = grow(matrix, plant("three", 0.8) + plant("one", 0.2) + plant("two", 0.5)).compete();
  const PlantId renamed[] = {1, 2, 0};
  for (std::size_t i = 0; i < a.population.plants.size(); ++i) {
    const PlantId plant = a.population.plants[i];
    ASSERT_EQ(b.population.plants[i], plant == no_plant ? no_plant : renamed[plant]);
  }
}

// C4: passes settle, and stop when nothing changes.
TEST(Neighbourhoods, PassesSettle) {
  const Competition result = grow(rivalry(0.2, "passes=\"20\"")).compete();
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
  const Competition result = grown.compete();
  EXPECT_DOUBLE_EQ(result.report.cell_m, 240);
  EXPECT_EQ(result.report.fixings, grown.scene.offsets.back());
}

// Suppression thins: fewer plants stand where neighbours press harder.
TEST(Neighbourhoods, SuppressionThinsTheStand) {
  const auto standing = [](double value) {
    const Competition c = grow(influences(value, 2), three, 800, "<establishment chance=\"stochastic\"/>").compete();
    return std::count_if(c.population.plants.begin(), c.population.plants.end(),
                         [](PlantId p) { return p != no_plant; });
  };
  const auto none = standing(0), some = standing(-0.2), much = standing(-0.5);
  EXPECT_GT(none, some);
  EXPECT_GT(some, much);
}

}  // namespace
}  // namespace silvasim::population
