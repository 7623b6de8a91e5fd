// The block engine over whole scenes: bounds, normalization, threads, and a scalar second way.
#include "silvasim/evaluators/network.h"

#include <gtest/gtest.h>

#include <cmath>

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

TEST(Network, NormalizeLeavesAllZeroZero) {
  const Scene scene =
      make_scene(tiles + "<pipeline><ConstantEvaluator value=\"0\" floor=\"0\"/><NormalizeEvaluator/></pipeline>",
                 plants, {wave, holed});
  const Suitability result = evaluate_sites(Network(scene.scenario, 0), scene.ground());
  for (const float p : result.probability) ASSERT_TRUE(p == 0 || p == excluded);
}

TEST(Network, SameBytesWithAnyNumberOfThreads) {
  for (const std::string& pipeline : pipelines()) {
    const Scene scene = make_scene(tiles + pipeline, plants, {wave, holed});
    const Network network(scene.scenario, 0);
    std::vector<float> first;
    for (int threads : {1, 2, 3, 8}) {
      const base::ThreadLimit limit(threads);
      const Suitability result = evaluate_sites(network, scene.ground());
      if (first.empty()) first = result.probability;
      ASSERT_EQ(result.probability, first) << threads << " threads, " << pipeline;
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
