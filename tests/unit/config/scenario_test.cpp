// The two files to a scenario, and the words of its errors.
#include <gtest/gtest.h>

#include "tests/unit/config/files.h"

namespace silvasim::config {
namespace {

const char* const paper_plants =
    "<plants>\n"
    "<plant><model> ./model/oak.obj </model><property name=\"MinMaxWater\"><MinMax min=\"0.2\" "
    "max=\"0.5\"/></property></plant>\n"
    "</plants>\n";
const char* const paper_ecosystem =
    "<ecosystem>\n"
    "<scene><size width=\"1 km\" height=\"1 km\"/></scene>\n"
    "<datafield name=\"Waterfield\">water.png</datafield>\n"
    "<MinMaxEvaluator lethal=\"true\" "
    "optimum=\"false\"><datafield>Waterfield</datafield><property>MinMaxWater</property>"
    "</MinMaxEvaluator>\n"
    "</ecosystem>\n";

TEST(Scenario, ThePapersOwnFragmentsLoad) {
  Files files;
  files.add("ecosystem.xml", paper_ecosystem).add("plants.xml", paper_plants);
  EXPECT_EQ(files.errors(), "");
  const Scenario scenario = files.load();
  ASSERT_EQ(scenario.layers.size(), 1u);
  const LayerSettings& layer = scenario.layers[0];
  ASSERT_EQ(layer.species.size(), 1u);
  EXPECT_EQ(layer.species[0].name, "oak");
  EXPECT_EQ(layer.species[0].model, "./model/oak.obj");
  ASSERT_EQ(layer.pipeline.steps.size(), 1u);
  EXPECT_TRUE(layer.pipeline.steps[0].lethal);
  EXPECT_EQ(layer.pipeline.steps[0].field, 0);
  EXPECT_EQ(scenario.name, "ecosystem");
  EXPECT_EQ(scenario.files.size(), 2u);
}

struct Wrong {
  const char* ecosystem;
  const char* plants;
  const char* expected;
};

// Wraps what is wrong into a configuration that is otherwise right.
std::string ecosystem(const std::string& inside) {
  return "<ecosystem>\n<datafield name=\"water\">water.png</datafield>\n" + inside + "\n</ecosystem>";
}
std::string evaluator(const std::string& text =
                          "<FunctionEvaluator><datafield>water</datafield><property>W</property></FunctionEvaluator>") {
  return "<pipeline>" + text + "</pipeline>";
}
std::string plants(const std::string& inside = "<property name=\"W\"><MinMax min=\"0\" max=\"1\"/></property>") {
  return "<plants>\n<plant name=\"oak\">" + inside + "</plant>\n</plants>";
}

std::string errors(const std::string& ecosystem_xml, const std::string& plants_xml) {
  Files files;
  files.add("ecosystem.xml", ecosystem_xml).add("plants.xml", plants_xml);
  return files.errors();
}

TEST(Scenario, ARightOneHasNoErrors) { EXPECT_EQ(errors(ecosystem(evaluator()), plants()), ""); }

TEST(Scenario, ErrorsNameTheThingAndWhatWouldBeRight) {
  EXPECT_EQ(
      errors(ecosystem(
                 evaluator("<FunctionEvaluator><datafield>watr</datafield><property>W</property></FunctionEvaluator>")),
             plants()),
      "ecosystem.xml:3:30: error: <FunctionEvaluator> uses the unknown data field \"watr\"; did you mean \"water\"?\n");
  EXPECT_EQ(errors(ecosystem(evaluator()), plants("<property name=\"V\"><MinMax min=\"0\" max=\"1\"/></property>")),
            "plants.xml:2:1: error: plant \"oak\" has no property \"W\", which <FunctionEvaluator> at ecosystem.xml:3 "
            "asks for\n");
  EXPECT_EQ(errors(ecosystem(evaluator()), plants("<property name=\"W\"><MinMax min=\"1\" max=\"0\"/></property>")),
            "plants.xml:2:38: error: <MinMax> reversed: min=\"1\" is above max=\"0\"\n");
  EXPECT_EQ(errors(ecosystem(evaluator()),
                   plants("<property name=\"W\"><Trapezoid a=\"1\" b=\"3\" c=\"2\" d=\"4\"/></property>")),
            "plants.xml:2:38: error: <Trapezoid>: a, b, c, d must not fall: b=\"3\" is above c=\"2\"\n");
  EXPECT_EQ(errors(ecosystem(evaluator()), plants("<scale least=\"2\" most=\"1\"/><property name=\"W\"><MinMax "
                                                  "min=\"0\" max=\"1\"/></property>")),
            "plants.xml:2:19: error: <scale> reversed: least=\"2\" is above most=\"1\"\n");
  EXPECT_EQ(errors(ecosystem("<scene><extent west=\"3\" south=\"0\" east=\"1\" north=\"9\"/></scene>" + evaluator()),
                   plants()),
            "ecosystem.xml:3:8: error: <extent> reversed or empty: west=\"3\" is not less than east=\"1\"\n");
  EXPECT_EQ(errors(ecosystem("<datafield name=\"soil\" scale=\"0\">water.png</datafield>" + evaluator()), plants()),
            "ecosystem.xml:3:24: error: data field \"soil\": scale=\"0\" would give every cell the same value, its "
            "offset\n");
  EXPECT_NE(
      errors(ecosystem("<tiles colours=\"17\"/>" + evaluator()), plants()).find("expected a whole number, 3 to 16"),
      std::string::npos);
  EXPECT_EQ(errors(ecosystem(evaluator()),
                   plants("<property name=\"W\"><Classes><class code=\"1\" value=\"1\"/></Classes></property>")),
            "plants.xml:2:38: error: property \"W\" of \"oak\" is a <Classes>, but <FunctionEvaluator> at "
            "ecosystem.xml:3 takes <Gauss>, "
            "<Bezier>, <Table>, <Trapezoid>, <MinMax>, <Constant>\n");
  EXPECT_EQ(errors(ecosystem("<datafield name=\"water\">water.png</datafield>" + evaluator()), plants()),
            "ecosystem.xml:3:1: error: data field \"water\" stands twice; the first is at ecosystem.xml:2\n");
  EXPECT_EQ(errors(ecosystem("<datafield name=\"soil\">soil.tif</datafield>" + evaluator()), plants()),
            "ecosystem.xml:3:1: error: data field \"soil\": there is no file \"soil.tif\"\n");
  EXPECT_EQ(
      errors(ecosystem("<tiles side=\"50 m\"><radii least=\"2 m\" most=\"8 m\"/></tiles>" + evaluator()), plants()),
      "ecosystem.xml:3:1: error: <tiles>: side 50 m is not larger than 8 times the largest radius, 64 m; enlarge side "
      "or lessen "
      "radii\n");
  EXPECT_EQ(errors(ecosystem("<tiles><radii least=\"8 m\" most=\"2 m\"/></tiles>" + evaluator()), plants()),
            "ecosystem.xml:3:8: error: <radii> reversed: least=\"8 m\" is above most=\"2 m\"\n");
  EXPECT_EQ(errors(ecosystem("<derivedfield name=\"slope\" measure=\"slope\"/>" + evaluator()), plants()),
            "ecosystem.xml:3:1: error: derived field \"slope\" needs a terrain: a <datafield terrain=\"true\">, or "
            "of=\"...\"\n");
  EXPECT_EQ(errors(ecosystem("<neighbourhoods><influence from=\"ok\" on=\"*\" value=\"-0.5\"/></neighbourhoods>" +
                             evaluator()),
                   plants()),
            "ecosystem.xml:3:17: error: <influence> names the unknown plant \"ok\"; did you mean \"oak\"?\n");
  EXPECT_EQ(
      errors(ecosystem(evaluator("<RadiusEvaluator/>") + "<RadiusEvaluator/>"), plants()),
      "ecosystem.xml:3:40: error: <RadiusEvaluator> stands beside the <pipeline> at ecosystem.xml:3; move it inside\n");
  EXPECT_EQ(
      errors(
          ecosystem(evaluator("<ClassEvaluator><datafield>water</datafield><property>W</property></ClassEvaluator>")),
          plants("<property name=\"W\"><Classes><class code=\"1\" value=\"1\"/></Classes></property>")),
      "ecosystem.xml:3:11: error: <ClassEvaluator> needs classes, but data field \"water\" is a quantity; say "
      "kind=\"class\" there, "
      "or use a <FunctionEvaluator>\n");
  EXPECT_EQ(errors(ecosystem(evaluator("<length><NormalizeEvaluator/></length>")), plants()),
            "ecosystem.xml:3:19: error: <NormalizeEvaluator> must stand in the pipeline itself, not in a group\n");
  EXPECT_EQ(errors(ecosystem(evaluator()), "<plants><plant name=\"oak\" layer=\"shrub\"/></plants>"),
            "plants.xml:1:27: error: plant \"oak\" grows in the unknown layer \"shrub\"\n"
            "ecosystem.xml:1:1: error: no plant grows in layer \"plants\"\n");
  EXPECT_EQ(errors(ecosystem(""), plants()),
            "ecosystem.xml:1:1: error: layer \"plants\" has no evaluators; <pipeline> needs one at least\n");
}

TEST(Scenario, AllErrorsOfBothFilesAreShownTogether) {
  const std::string text = errors(ecosystem("<tiles sde=\"5\"/>" + evaluator("<FunctionEvaluator/>")),
                                  plants("<property name=\"W\"><MinMax min=\"a\" max=\"1\"/></property>"));
  EXPECT_NE(text.find("has no attribute \"sde\"; did you mean \"side\"?"), std::string::npos) << text;
  EXPECT_NE(text.find("<FunctionEvaluator> needs a <datafield>"), std::string::npos) << text;
  EXPECT_NE(text.find("plants.xml:2:46: error: <MinMax> min: \"a\" is no number"), std::string::npos) << text;
}

TEST(Scenario, IncludesAreSplicedAndCyclesRefused) {
  Files files;
  files.add("ecosystem.xml", "<ecosystem><include>more.xml</include>" + evaluator() + "</ecosystem>")
      .add("more.xml", "<ecosystem><datafield name=\"water\">water.png</datafield></ecosystem>")
      .add("plants.xml", plants());
  EXPECT_EQ(files.errors(), "");
  EXPECT_EQ(files.load().files.size(), 3u);
  files.add("more.xml", "<ecosystem>\n<include>ecosystem.xml</include></ecosystem>");
  EXPECT_NE(files.errors().find("more.xml:2:1: error: <include> of \"ecosystem.xml\", which is being read already"),
            std::string::npos);
}

TEST(Scenario, NamedInfluencesBeatStars) {
  Files files;
  files
      .add("ecosystem.xml",
           ecosystem("<neighbourhoods><influence from=\"*\" on=\"*\" value=\"-0.1\"/><influence from=\"oak\" on=\"*\" "
                     "value=\"-0.2\"/><influence from=\"oak\" on=\"elm\" value=\"-0.3\"/></neighbourhoods>" +
                     evaluator("<RadiusEvaluator/>")))
      .add("plants.xml",
           "<plants><plant name=\"oak\"/><plant name=\"elm\"><influence on=\"elm\" value=\"0.5\"/></plant></plants>");
  EXPECT_EQ(files.errors(), "");
  EXPECT_EQ(files.load().layers[0].neighbourhoods.influence, (std::vector<double>{-0.2, -0.3, -0.1, 0.5}));
}

TEST(Scenario, ASpeciesMayGrowInSeveralLayersButOnceInEach) {
  Files files;
  const std::string neighbours = "<neighbourhoods/><RadiusEvaluator/></layer>";
  files
      .add("ecosystem.xml",
           "<ecosystem><layer name=\"trees\">" + neighbours + "<layer name=\"shrubs\">" + neighbours + "</ecosystem>")
      .add("plants.xml",
           "<plants>\n<plant name=\"beech\" layer=\"trees\"><influence on=\"*\" value=\"-0.1\"/></plant>\n"
           "<plant name=\"beech\" layer=\"shrubs\"><influence on=\"*\" value=\"0.2\"/></plant></plants>");
  EXPECT_EQ(files.errors(), "");
  const Scenario scenario = files.load();
  EXPECT_EQ(scenario.layers[0].neighbourhoods.influence, std::vector<double>{-0.1});
  EXPECT_EQ(scenario.layers[1].neighbourhoods.influence, std::vector<double>{0.2});
  files.add("plants.xml",
            "<plants>\n<plant name=\"beech\" layer=\"trees\"/>\n<plant name=\"beech\" layer=\"shrubs\"/>\n"
            "<plant name=\"beech\"/></plants>");
  EXPECT_EQ(files.errors(),
            "plants.xml:4:1: error: plant \"beech\" stands twice in layer \"trees\"; the first is at plants.xml:2\n");
}

TEST(Scenario, TooManyPlantsAreRefusedBeforeTheyAreMatched) {
  std::string plants = "<plants>";
  for (int i = 0; i < 100'000; ++i) plants += "<plant name=\"a" + std::to_string(i) + "\"/>";
  EXPECT_EQ(errors(ecosystem(evaluator("<RadiusEvaluator/>")), plants + "</plants>"),
            "ecosystem.xml:1:1: error: layer \"plants\" has more than 4096 plants\n");
}

TEST(Scenario, ThePlantsFileMayLieElsewhere) {
  Files files;
  files.add("ecosystem.xml", ecosystem(evaluator())).add("flora.xml", plants());
  EXPECT_NE(files.errors().find("no plants file"), std::string::npos);
  EXPECT_NO_THROW(load_scenario(files.path("ecosystem.xml"), files.path("flora.xml"), evaluators::dialect()));
}

TEST(Scenario, TheHashChangesWithEachFile) {
  Files files;
  files.add("ecosystem.xml", ecosystem(evaluator())).add("plants.xml", plants());
  const std::string before = files.load().sha256;
  EXPECT_EQ(files.load().sha256, before);
  files.add("plants.xml", plants() + "\n");
  EXPECT_NE(files.load().sha256, before);
}

}  // namespace
}  // namespace silvasim::config
