// What explain() says, against what the simulation did: every number and every reason must be the true one.
#include "silvasim/explain.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "silvasim/config/load.h"
#include "silvasim/evaluators/evaluator.h"

namespace silvasim {
namespace {

using ::testing::HasSubstr;

// A scenario of one field (0 in the west, 1 in the east) with the given pipeline, plants and rest.
class Place {
 public:
  Place(const std::string& plants, const std::string& rest) {
    static int serial = 0;
    folder_ = std::filesystem::temp_directory_path() /
              ("silva-explain-" + std::to_string(getpid()) + "-" + std::to_string(serial++));
    std::filesystem::create_directories(folder_);
    std::ofstream grid(folder_ / "east.asc");
    grid << "ncols 40\nnrows 40\nxllcorner 0\nyllcorner 0\ncellsize 10\nNODATA_value -1\n";
    for (int row = 0; row < 40; ++row) {
      for (int column = 0; column < 40; ++column) grid << (column >= 38 ? -1 : column / 40.0) << ' ';
      grid << '\n';
    }
    grid.close();
    std::ofstream(folder_ / "plants.xml") << "<plants>" << plants << "</plants>";
    std::ofstream(folder_ / "ecosystem.xml")
        << "<ecosystem><scene crs=\"local\"><extent west=\"0\" south=\"0\" east=\"400\" north=\"400\"/></scene>"
        << "<tiles side=\"100\"><radii least=\"2\" most=\"4\"/></tiles>" << rest << "</ecosystem>";
    scenario_ = config::load_scenario(folder_ / "ecosystem.xml", {}, evaluators::dialect());
  }
  ~Place() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  SiteExplanation at(double x, double y) const { return explain(scenario_, {x, y}, false)[0]; }

 private:
  std::filesystem::path folder_;
  config::Scenario scenario_;
};

std::string plant(const std::string& name, const std::string& vigour) {
  return "<plant name=\"" + name + "\"><scale least=\"0\" most=\"9\"/><neighbourhood radius=\"20 m\"/>" +
         "<property name=\"Vigour\"><Constant value=\"" + vigour + "\"/></property></plant>";
}

const std::string vigour = "<ConstantEvaluator><property>Vigour</property></ConstantEvaluator>";

// Visits explanations of points all over the place.
template <typename Visit>
void all_over(const Place& place, int count, Visit&& visit) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> within(1, 370);
  for (int i = 0; i < count; ++i) {
    const double x = within(random), y = within(random);
    SCOPED_TRACE(testing::Message() << x << "," << y);
    visit(place.at(x, y));
  }
}

// The factors of the plants that acted, and of no others, lead from the probability before to the one after.
TEST(Explain, NeighboursAccountForTheChange) {
  for (const char* const passes : {"1", "2", "3"}) {
    const Place place(plant("a", "0.9") + plant("b", "0.8"),
                      "<pipeline>" + vigour +
                          "</pipeline><establishment chance=\"certain\"/><neighbourhoods passes=\"" + passes +
                          "\"><influence from=\"*\" on=\"*\" value=\"-0.3\"/></neighbourhoods>");
    int acted = 0;
    all_over(place, 40, [&](const SiteExplanation& e) {
      ASSERT_NE(e.candidate, ecosystem::no_plant);
      double product = static_cast<double>(e.abiotic_probability);
      for (const NeighbourEffect& n : e.neighbours) product *= static_cast<double>(n.factor);
      EXPECT_NEAR(product, static_cast<double>(e.probability), 1e-4);
      acted += e.neighbours.empty() ? 0 : 1;
    });
    EXPECT_GT(acted, 20) << passes;
  }
}

TEST(Explain, NeighboursThatLeaveNothingAreBlamed) {
  const Place place(plant("a", "0.9"), "<pipeline>" + vigour +
                                           "</pipeline><establishment chance=\"certain\"/><neighbourhoods passes=\"2\">"
                                           "<influence from=\"*\" on=\"*\" value=\"-3\"/></neighbourhoods>");
  int bare = 0;
  all_over(place, 40, [&](const SiteExplanation& e) {
    if (e.candidate != ecosystem::no_plant) return;
    ++bare;
    EXPECT_THAT(e.sentence, HasSubstr("neighbours leave no plant a chance"));
    EXPECT_FALSE(e.neighbours.empty());
  });
  EXPECT_GT(bare, 10);
}

TEST(Explain, ADrawIsNotCalledTheBest) {
  const Place place(plant("weak", "0.3") + plant("strong", "0.6"),
                    "<pipeline>" + vigour + "</pipeline><establishment selection=\"weighted\"/>");
  int weak = 0;
  all_over(place, 60, [&](const SiteExplanation& e) {
    ASSERT_NE(e.candidate, ecosystem::no_plant);
    EXPECT_THAT(e.sentence, HasSubstr("drawn"));
    EXPECT_EQ(e.sentence.find("suits the site best"), std::string::npos);
    if (e.plant != 0) return;
    ++weak;
    EXPECT_THAT(e.sentence, HasSubstr("suits strong best, with 0.6"));
  });
  EXPECT_GT(weak, 3);
}

// The step that ruled a plant out is named: not one whose zero does not count, nor a field whose missing data does not.
TEST(Explain, TheTrueReasonIsNamed) {
  const std::string field = "<datafield name=\"east\" nodata=\"ignore\">east.asc</datafield>";
  const std::string asks = "<datafield>east</datafield><property>East</property>";
  const std::string east = "<property name=\"East\"><MinMax min=\"5\" max=\"6\"/></property>";
  const std::string huge = "<model radius=\"100 m\"/>";
  const Place place("<plant name=\"a\">" + huge + "<scale least=\"0.9\" most=\"1.1\"/>" + east + "</plant>",
                    field + "<pipeline><MinMaxEvaluator>" + asks + "</MinMaxEvaluator><RadiusEvaluator/></pipeline>");
  EXPECT_THAT(place.at(200, 200).sentence, HasSubstr("RadiusEvaluator gives 0"));
  EXPECT_THAT(place.at(398, 200).sentence, HasSubstr("RadiusEvaluator gives 0")) << "no data there, which is ignored";

  const std::string strict = "<datafield name=\"east\">east.asc</datafield>";
  const Place missing(
      "<plant name=\"a\"><scale least=\"0\" most=\"9\"/>" + east + "</plant>",
      strict + "<pipeline><RadiusEvaluator/><FunctionEvaluator>" + asks + "</FunctionEvaluator></pipeline>");
  EXPECT_THAT(missing.at(398, 200).sentence, HasSubstr("field \"east\" has no data there"));
}

}  // namespace
}  // namespace silvasim
