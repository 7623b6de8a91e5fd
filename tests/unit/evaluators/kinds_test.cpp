// Each Evaluator on a few sites with known answers.
#include <gtest/gtest.h>

#include <cmath>

#include "silvasim/evaluators/network.h"
#include "tests/unit/config/files.h"

namespace silvasim::evaluators {
namespace {

struct Given {
  std::vector<float> radius, field;
  std::vector<std::uint8_t> no_data = {};
};

// Runs a pipeline of one field over the sites; the first species' probabilities.
std::vector<float> run(const std::string& pipeline, const std::string& plant, const Given& given,
                       const std::string& field_attributes = "") {
  config::Files files;
  files
      .add("ecosystem.xml", "<ecosystem><datafield name=\"f\" " + field_attributes + ">water.png</datafield>" +
                                pipeline + "</ecosystem>")
      .add("plants.xml",
           "<plants><plant name=\"p\">" + plant + "</plant><plant name=\"other\">" + plant + "</plant></plants>");
  const config::Scenario scenario = files.load();
  const Network network(scenario, 0);
  std::vector<std::uint8_t> no_data = given.no_data;
  no_data.resize(given.field.size(), 0);
  Network::Block block;
  block.count = given.field.size();
  block.radius_m = given.radius.data();
  for (std::size_t k = 0; k < network.fields().size(); ++k) {
    block.value.push_back(given.field.data());
    block.no_data.push_back(no_data.data());
  }
  Network::Scratch scratch;
  std::vector<float> all(block.count * network.species()), first;
  for (std::size_t stage = 0; stage < network.stages(); ++stage) network.run(stage, block, scratch, all.data());
  for (std::size_t i = 0; i < block.count; ++i) first.push_back(all[i * network.species()]);
  return first;
}

using Floats = std::vector<float>;
const std::string range = "<property name=\"R\"><MinMax min=\"2\" max=\"6\"/></property>";
const std::string tent = "<datafield>f</datafield><property>R</property>";

TEST(Kinds, RadiusAsksWhetherTheModelScalesToTheSite) {
  EXPECT_EQ(run("<RadiusEvaluator/>", "<model radius=\"4 m\"/><scale least=\"0.5\" most=\"1.5\"/>",
                {{1.9f, 2, 4, 6, 6.1f}, {0, 0, 0, 0, 0}}),
            (Floats{excluded, 1, 1, 1, excluded}));
}

TEST(Kinds, MinMaxLethalExcludesAndFloorKeeps) {
  const Given sites{{1, 1, 1}, {1, 4, 7}};
  EXPECT_EQ(run("<MinMaxEvaluator lethal=\"true\">" + tent + "</MinMaxEvaluator>", range, sites),
            (Floats{excluded, 1, excluded}));
  EXPECT_EQ(run("<MinMaxEvaluator>" + tent + "</MinMaxEvaluator>", range, sites), (Floats{0.01f, 1, 0.01f}));
  EXPECT_EQ(run("<MinMaxEvaluator floor=\"0\">" + tent + "</MinMaxEvaluator>", range, sites), (Floats{0, 1, 0}));
}

TEST(Kinds, MinMaxOptimumIsATent) {
  EXPECT_EQ(run("<MinMaxEvaluator optimum=\"true\" floor=\"0\">" + tent + "</MinMaxEvaluator>", range,
                {{1, 1, 1, 1, 1}, {1, 2, 3, 4, 5}}),
            (Floats{0, 0, 0.5f, 1, 0.5f}));
}

TEST(Kinds, GradientFallsBothWays) {
  EXPECT_EQ(run("<GradientEvaluator from=\"1\" to=\"3\" floor=\"0\"><datafield>f</datafield></GradientEvaluator>", "",
                {{1, 1, 1, 1}, {0, 1, 2, 3}}),
            (Floats{1, 1, 0.5f, 0}));
  EXPECT_EQ(run("<GradientEvaluator from=\"3\" to=\"1\" floor=\"0\"><datafield>f</datafield></GradientEvaluator>", "",
                {{1, 1, 1, 1}, {1, 2, 3, 4}}),
            (Floats{0, 0.5f, 1, 1}));
}

TEST(Kinds, DistanceIsTestedAgainstTheCrown) {
  // A stem 8 m from the road is far enough for a crown of 3 m, not for one of 3.5 m.
  EXPECT_EQ(
      run("<DistanceEvaluator least=\"5 m\"><datafield>f</datafield></DistanceEvaluator>", "", {{3, 3.5f}, {8, 8}}),
      (Floats{1, excluded}));
  EXPECT_EQ(run("<DistanceEvaluator most=\"5 m\"><datafield>f</datafield></DistanceEvaluator>", "", {{3, 2}, {8, 8}}),
            (Floats{1, excluded}));
}

TEST(Kinds, ConstantByValueAndByProperty) {
  EXPECT_EQ(run("<ConstantEvaluator value=\"0.5\"/>", "", {{1}, {1}}), (Floats{0.5f}));
  EXPECT_EQ(run("<ConstantEvaluator><property>C</property></ConstantEvaluator>",
                "<property name=\"C\"><Constant value=\"0.25\"/></property>", {{1}, {1}}),
            (Floats{0.25f}));
}

TEST(Kinds, AnEvaluatorMayBeLimitedToAPlant) {
  EXPECT_EQ(run("<ConstantEvaluator value=\"0.5\"><plant>other</plant></ConstantEvaluator>", "", {{1}, {1}}),
            (Floats{1}));
  EXPECT_EQ(run("<ConstantEvaluator value=\"0.5\"><plant>p</plant></ConstantEvaluator>", "", {{1}, {1}}),
            (Floats{0.5f}));
}

TEST(Kinds, MissingDataFollowsTheFieldsPolicy) {
  const Given sites{{1, 1}, {4, 0}, {0, 1}};
  const std::string pipeline = "<MinMaxEvaluator>" + tent + "</MinMaxEvaluator>";
  EXPECT_EQ(run(pipeline, range, sites), (Floats{1, excluded}));
  EXPECT_EQ(run(pipeline, range, sites, "nodata=\"ignore\""), (Floats{1, 1}));
  EXPECT_EQ(run(pipeline, range, {{1, 1}, {4, 9}, {0, 1}}, "nodata=\"fill\" fill=\"9\""), (Floats{1, 0.01f}));
}

TEST(Kinds, LengthIsMilderThanProduct) {
  const std::string zero = "<ConstantEvaluator value=\"0\"/>", one = "<ConstantEvaluator value=\"1\"/>";
  EXPECT_EQ(run("<pipeline>" + zero + one + "</pipeline>", "", {{1}, {1}}), (Floats{0.01f}));
  const Floats length = run("<pipeline><length>" + zero + one + "</length></pipeline>", "", {{1}, {1}});
  EXPECT_NEAR(length[0], std::sqrt(0.5), 1e-7);
  EXPECT_EQ(run("<pipeline><length>" + one + one + one + "</length></pipeline>", "", {{1}, {1}}), (Floats{1}));
  EXPECT_EQ(run("<pipeline combine=\"length\">" + one + one + one + "</pipeline>", "", {{1}, {1}}), (Floats{1}));
  EXPECT_EQ(run("<pipeline><length><ConstantEvaluator value=\"0\" lethal=\"true\"/>" + one + "</length></pipeline>", "",
                {{1}, {1}}),
            (Floats{excluded}));
}

}  // namespace
}  // namespace silvasim::evaluators
