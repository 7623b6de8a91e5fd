// The block engine over whole scenes: bounds, normalization, threads, and a scalar second way.
#include "silvasim/evaluators/network.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <random>

#include "silvasim/base/parallel.h"
#include "silvasim/evaluators/trace.h"
#include "tests/unit/evaluators/scene.h"

namespace silvasim::evaluators {
namespace {

const char* const plants =
    "<plant name=\"one\"><property name=\"A\"><Gauss mean=\"0.4\" deviation=\"0.2\"/></property><property "
    "name=\"B\"><Trapezoid a=\"0\" b=\"0.2\" "
    "c=\"0.6\" d=\"1\"/></property></plant>"
    "<plant name=\"two\"><property name=\"A\"><Bezier><point x=\"0\" y=\"0\"/><point x=\"0.4\" y=\"0\"/><point "
    "x=\"0.6\" y=\"1\"/><point x=\"1\" "
    "y=\"1\"/></Bezier></property><property name=\"B\"><MinMax min=\"0.1\" max=\"0.8\"/></property></plant>"
    "<plant name=\"three\"><scale least=\"0.8\" most=\"1.4\"/><property name=\"A\"><Table><point x=\"0\" "
    "y=\"1\"/><point x=\"1\" "
    "y=\"0\"/></Table></property><property name=\"B\"><Constant value=\"0.7\"/></property></plant>";

double wave(double x, double y) { return 0.5 + 0.5 * std::sin(x / 37) * std::cos(y / 53); }
double holed(double x, double y) { return x > 100 && x < 140 && y > 200 ? NAN : 0.5 + 0.5 * std::cos(x / 71 + y / 29); }

std::string function(const std::string& field, const std::string& property, const std::string& attributes = "") {
  return "<FunctionEvaluator " + attributes + "><datafield>" + field + "</datafield><property>" + property +
         "</property></FunctionEvaluator>";
}

// Pipelines of every form, for the tests that must hold for all.
std::vector<std::string> pipelines() {
  const std::string a = function("a", "A"), b = function("b", "B"), lethal = function("b", "B", "lethal=\"true\"");
  return {
      "<pipeline>" + a + b + "</pipeline>",
      "<pipeline combine=\"length\">" + a + lethal + "</pipeline>",
      "<pipeline><RadiusEvaluator/>" + a + "<NormalizeEvaluator/><length>" + b + "<product>" + a + lethal +
          "</product></length></pipeline>",
      "<pipeline combine=\"length\">" + a + "<NormalizeEvaluator/>" + b +
          "<ConstantEvaluator value=\"0.3\"><plant>two</plant></ConstantEvaluator>"
          "<NormalizeEvaluator/></pipeline>",
      "<pipeline>" + lethal + "<length>" + a + "<length>" + b +
          "<ConstantEvaluator value=\"0\"/></length></length><NormalizeEvaluator/></pipeline>",
  };
}

const std::string tiles = "<tiles side=\"80 m\"><radii least=\"2 m\" most=\"6 m\"/></tiles>";

// A land whose sites fill several of the runs of some 8,000 that threads work on, and whose probabilities several of the
// pieces of 2^18 in which they are normalized. Positions are multiples of 1/64 m, so that they are exact in any frame.
constexpr double large_side = 3200;

Scene large_scene(const std::string& pipeline, const std::string& with_plants = plants,
                  const FieldFunctions& functions = {wave, holed}) {
  Scene scene = make_scene(tiles + pipeline, with_plants, functions, large_side);
  for (tiles::Tile& tile : scene.tile_set.tiles) {
    for (tiles::Site& site : tile.sites) {
      site.x_m = std::floor(site.x_m * 64) / 64;
      site.y_m = std::floor(site.y_m * 64) / 64;
    }
  }
  EXPECT_GT(scene.offsets.back(), 90000u) << "too few sites for runs and pieces to be many";
  return scene;
}

TEST(Network, ProbabilitiesStayWithinBounds) {
  for (const std::string& pipeline : pipelines()) {
    const Scene scene = make_scene(tiles + pipeline, plants, {wave, holed});
    const Network network(scene.scenario, 0);
    const Suitability result = evaluate_sites(network, scene.ground());
    ASSERT_GT(result.probability.size(), 1000u);
    for (const float p : result.probability)
      ASSERT_TRUE(p == excluded || (p >= 0 && p <= 1)) << p << " in " << pipeline;
  }
}

// B1: the maximum is exactly 1 after a normalization.
TEST(Network, NormalizeMakesTheLargestExactlyOne) {
  const Scene scene = make_scene(
      tiles + "<pipeline><ConstantEvaluator value=\"0.3\"/>" + function("a", "A") + "<NormalizeEvaluator/></pipeline>",
      plants, {wave, holed});
  const Suitability result = evaluate_sites(Network(scene.scenario, 0), scene.ground());
  ASSERT_EQ(result.maxima.size(), 1u);
  EXPECT_LE(result.maxima[0], 0.3f);
  EXPECT_EQ(*std::max_element(result.probability.begin(), result.probability.end()), 1.0f);
}

// B1: over all sites, wherever the largest stands.
TEST(Network, NormalizeFindsTheLargestOfAllSites) {
  const std::string linear =
      "<plant name=\"only\"><property name=\"A\"><Table><point x=\"0\" y=\"0\"/><point x=\"1\" "
      "y=\"1\"/></Table></property></plant>";
  const std::string raw = "<pipeline><ConstantEvaluator value=\"0.3\"/>" + function("a", "A");
  for (const double summit : {0.1, 0.5, 0.9}) {  // from south to north; sites are listed from the north
    const auto hill = [&](double x, double y) {
      return 0.1 + 0.8 * std::exp(-std::hypot(x / large_side - 0.5, y / large_side - summit));
    };
    const Scene scene = large_scene(raw + "<NormalizeEvaluator/></pipeline>", linear, {hill});
    const Scene bare = large_scene(raw + "</pipeline>", linear, {hill});
    const Suitability result = evaluate_sites(Network(scene.scenario, 0), scene.ground());
    const Suitability before = evaluate_sites(Network(bare.scenario, 0), bare.ground());
    const auto largest = std::max_element(before.probability.begin(), before.probability.end());
    EXPECT_NEAR(static_cast<double>(largest - before.probability.begin()) / static_cast<double>(scene.offsets.back()),
                1 - summit, 0.05);
    ASSERT_EQ(result.maxima, std::vector{*largest});
    for (std::size_t i = 0; i < result.probability.size(); ++i) {
      ASSERT_EQ(result.probability[i], before.probability[i] / *largest) << "site " << i;
    }
    EXPECT_EQ(*std::max_element(result.probability.begin(), result.probability.end()), 1.0f);
  }
}

TEST(Network, NormalizeLeavesAllZeroZero) {
  const Scene scene =
      make_scene(tiles + "<pipeline><ConstantEvaluator value=\"0\" floor=\"0\"/><NormalizeEvaluator/></pipeline>",
                 plants, {wave, holed});
  const Suitability result = evaluate_sites(Network(scene.scenario, 0), scene.ground());
  ASSERT_GT(result.probability.size(), 1000u);
  for (const float p : result.probability) ASSERT_EQ(p, 0.0f);  // all sites lie inside and nothing excludes
  EXPECT_EQ(result.maxima, std::vector{0.0f});
}

// B1: the order of the sites changes nothing. All sites of the land as one tile in a random order are a single run, whose
// blocks hold other sites.
TEST(Network, TheOrderOfSitesDoesNotMatter) {
  for (const std::string& pipeline : pipelines()) {
    const Scene scene = large_scene(pipeline);
    std::vector<tiles::Site> sites;
    for (int row = 0; row < scene.tiling.rows; ++row) {
      for (int column = 0; column < scene.tiling.columns; ++column) {
        for (tiles::Site site : scene.tile_set.tiles[scene.tiling.at(column, row)].sites) {
          site.x_m += static_cast<float>(column) * 80;
          site.y_m += static_cast<float>(scene.tiling.rows - 1 - row) * 80;
          sites.push_back(site);
        }
      }
    }
    std::vector<std::size_t> original(sites.size());
    std::iota(original.begin(), original.end(), 0);
    std::shuffle(original.begin(), original.end(), std::mt19937(5));
    tiles::Tile tile;
    for (const std::size_t i : original) tile.sites.push_back(sites[i]);
    const tiles::TileSet one_tile{large_side, scene.tile_set.most_radius_m, 1, 1, {tile}};
    const tiles::Tiling tiling{1, 1, {0}};
    const std::vector<std::uint64_t> offsets = {0, sites.size()};

    const Network network(scene.scenario, 0);
    const Suitability result = evaluate_sites(network, scene.ground());
    const Suitability shuffled =
        evaluate_sites(network, {one_tile, tiling, scene.ground().north_west, offsets, scene.fields});
    EXPECT_EQ(shuffled.maxima, result.maxima) << pipeline;
    for (std::size_t i = 0; i < original.size(); ++i) {
      for (std::size_t s = 0; s < 3; ++s) {
        ASSERT_EQ(shuffled.probability[i * 3 + s], result.probability[original[i] * 3 + s]) << pipeline;
      }
    }
  }
}

TEST(Network, SameBytesWithAnyNumberOfThreads) {
  for (const std::string& pipeline : pipelines()) {
    const Scene scene = large_scene(pipeline);
    const Network network(scene.scenario, 0);
    std::optional<Suitability> first;
    for (int threads : {1, 2, 3, 8}) {
      const base::ThreadLimit limit(threads);
      const Suitability result = evaluate_sites(network, scene.ground());
      if (!first) first = result;
      ASSERT_EQ(result.probability, first->probability) << threads << " threads, " << pipeline;
      ASSERT_EQ(result.maxima, first->maxima) << threads << " threads, " << pipeline;
    }
  }
}

// The explanation's scalar way and the engine's columns agree on every site.
TEST(Network, TraceAgreesWithTheEngine) {
  for (const std::string& pipeline : pipelines()) {
    const Scene scene = make_scene(tiles + pipeline, plants, {wave, holed});
    const Network network(scene.scenario, 0);
    const Ground ground = scene.ground();
    const Suitability result = evaluate_sites(network, ground);
    std::size_t index = 0, compared = 0;
    for (int row = 0; row < scene.tiling.rows; ++row) {
      for (int column = 0; column < scene.tiling.columns; ++column) {
        for (const tiles::Site& site : scene.tile_set.tiles[scene.tiling.at(column, row)].sites) {
          SiteColumns one;
          one.x = {ground.north_west.x + column * scene.tile_set.side_m + static_cast<double>(site.x_m)};
          one.y = {ground.north_west.y - (row + 1) * scene.tile_set.side_m + static_cast<double>(site.y_m)};
          one.radius_m = {site.radius_m};
          one.sample(network, scene.fields);
          const auto rows = trace(network, scene.scenario, one, result.maxima);
          for (std::size_t s = 0; s < result.species && !one.outside[0]; ++s, ++compared) {
            ASSERT_NEAR(rows.back().running[s], result.probability[index * result.species + s], 3e-7) << pipeline;
          }
          ++index;
        }
      }
    }
    EXPECT_GT(compared, 1000u);
  }
}

TEST(Network, SitesOutsideTheSceneTakeNothing) {
  Scene scene = make_scene(tiles + pipelines()[0], plants, {wave, holed});
  scene.fields.frame.extent.east = 200;
  const Suitability result = evaluate_sites(Network(scene.scenario, 0), scene.ground());
  std::size_t index = 0;
  for (int row = 0; row < scene.tiling.rows; ++row) {
    for (int column = 0; column < scene.tiling.columns; ++column) {
      for (const tiles::Site& site : scene.tile_set.tiles[scene.tiling.at(column, row)].sites) {
        const bool outside = column * 80.0 + static_cast<double>(site.x_m) > 200;
        if (outside) {
          ASSERT_EQ(result.probability[index * 3], excluded);
        }
        ++index;
      }
    }
  }
}

}  // namespace
}  // namespace silvasim::evaluators
