// The built ghosttile as a user runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <sstream>

#include "program.h"

namespace silvasim::cases {
namespace {

using testing::HasSubstr;

Outcome ghosttile(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), SILVA_BINARY_DIR "/ghosttile");
  return program(arguments);
}

const char* const stones = R"(<ghosttile side="40 cm" seed="2">
  <object name="stone" made="stone" length="8 cm" count="60"/>
  <object name="oak leaf" made="oak-leaf" count="60"><tilt to="30"/></object>
</ghosttile>)";

std::string scene_with(const std::string& fills) {
  return "<details seed=\"7\" ground=\"flat\"><tile>tile.xml</tile>" + fills + "</details>";
}
const char* const layer =
    "<fill object=\"stone\" density=\"0.5\"><layer to=\"5 cm\"/><box at=\"0,0,0\" size=\"6,6,1\"/></fill>"
    "<fill object=\"oak leaf\"><layer to=\"5 cm\"/><box at=\"0,0,0\" size=\"6,6,1\"/></fill>";

class Details : public testing::Test {
 protected:
  void SetUp() override {
    write(folder_ / "tile.xml", stones);
    write(folder_ / "scene.xml", scene_with(layer));
  }
  Outcome fill(std::vector<std::string> more = {}, const std::string& to = "a.details") {
    std::vector<std::string> all = {"fill", folder_ / "scene.xml", "-o", folder_ / to, "--json", "-q"};
    all.insert(all.end(), more.begin(), more.end());
    return ghosttile(all);
  }
  Folder folder_;
};

TEST_F(Details, GoFromXmlToFilledLandEditedAndBack) {
  const Outcome created = ghosttile({"create", folder_ / "tile.xml", "-o", folder_ / "t.ghost", "--json", "-q"});
  ASSERT_EQ(created.code, 0) << created.err;
  EXPECT_EQ(created.json()["candidates"], 120);
  ASSERT_EQ(fill().code, 0);
  const std::string before = read(folder_ / "a.details");

  write(folder_ / "strokes.xml",
        "<strokes><remove object=\"*\"><sphere at=\"1,1,0\" size=\"70 cm\"/></remove>"
        "<add object=\"stone\"><sphere at=\"-1,-1,0\" size=\"50 cm\"/></add></strokes>");
  const Outcome edited = ghosttile({"edit", folder_ / "a.details", folder_ / "strokes.xml", "--json", "-q"});
  ASSERT_EQ(edited.code, 0) << edited.err;
  EXPECT_EQ(edited.json()["edits"], 1);
  EXPECT_NE(read(folder_ / "a.details"), before);
  ASSERT_EQ(ghosttile({"edit", folder_ / "a.details", folder_ / "strokes.xml", "-q"}).code, 0);
  ASSERT_EQ(ghosttile({"edit", folder_ / "a.details", "--undo", "-q"}).code, 0);
  ASSERT_EQ(ghosttile({"edit", folder_ / "a.details", "--undo", "-q"}).code, 0);
  EXPECT_EQ(read(folder_ / "a.details"), before);
  const Outcome nothing = ghosttile({"edit", folder_ / "a.details", "--undo"});
  EXPECT_EQ(nothing.code, 1);
  EXPECT_THAT(nothing.err, HasSubstr("there is no edit to undo"));
}

// A heap is put where nothing was: beyond the layer's own tiles; and the copy knows its scene.
TEST_F(Details, EditsReachBeyondWhatTheSceneFilledAndOutputsKeepTheirScene) {
  ASSERT_EQ(fill({}, "a.details").code, 0);
  write(folder_ / "heap.xml", "<strokes><add object=\"stone\"><sphere at=\"0,0,1\" size=\"80 cm\"/></add></strokes>");
  std::filesystem::create_directory(folder_.path() / "below");
  const Outcome edited = ghosttile(
      {"edit", folder_ / "a.details", folder_ / "heap.xml", "-o", folder_ / "below/b.details", "--json", "-q"});
  ASSERT_EQ(edited.code, 0) << edited.err;
  EXPECT_GT(edited.json()["instances"].get<int>(), edited.json()["instances_before"].get<int>() + 100);
  const Outcome again = ghosttile({"edit", folder_ / "below/b.details", folder_ / "heap.xml", "-q"});
  EXPECT_EQ(again.code, 0) << again.err;
  const Outcome over =
      ghosttile({"edit", folder_ / "a.details", folder_ / "heap.xml", "-o", folder_ / "heap.xml", "-q"});
  EXPECT_EQ(over.code, 1);
  EXPECT_THAT(read(folder_ / "heap.xml"), HasSubstr("<strokes>"));
}

TEST_F(Details, AreTheSameBytesOnAnyNumberOfThreadsAndFromTheTilesOwnFile) {
  ASSERT_EQ(fill({"--threads", "1"}, "one.details").code, 0);
  ASSERT_EQ(fill({"--threads", "3"}, "three.details").code, 0);
  EXPECT_EQ(read(folder_ / "one.details"), read(folder_ / "three.details"));
  const auto instances = [&](const std::string& name) {
    return ghosttile({"info", folder_ / name, "--json"}).json()["objects"];
  };
  ASSERT_EQ(ghosttile({"create", folder_ / "tile.xml", "-o", folder_ / "tile.ghost", "-q"}).code, 0);
  write(folder_ / "scene.xml",
        "<details seed=\"7\" ground=\"flat\"><tile>tile.ghost</tile>" + std::string(layer) + "</details>");
  ASSERT_EQ(fill({}, "ghost.details").code, 0);
  EXPECT_EQ(instances("ghost.details"), instances("one.details"));
}

TEST_F(Details, ErrorsNameTheFileTheLineAndWhatWouldBeRight) {
  const auto refused = [&](const std::string& scene, const std::string& what, int code = 2) {
    write(folder_ / "scene.xml", scene);
    const Outcome outcome = fill();
    EXPECT_EQ(outcome.code, code) << scene;
    EXPECT_THAT(outcome.err, HasSubstr(what)) << scene;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.details")) << scene;
  };
  refused(scene_with("\n<fill object=\"stoen\"><layer to=\"5 cm\"/></fill>"),
          "scene.xml:2:7: error: the tile has no object \"stoen\"; did you mean \"stone\"?");
  refused(scene_with("<fill object=\"stone\"/>"), "holds no density element");
  refused(scene_with("<fill object=\"stone\"><sphere at=\"1, x\" size=\"1 m\"/></fill>"),
          "should be 2 or 3 numbers in metres");
  refused(scene_with("<fill object=\"stone\"><where><response><slope/></response></where></fill>"),
          "<where> asks for an ecosystem");
  refused(scene_with("<fill object=\"stone\"><trunks/></fill>"), "<trunks> asks for an ecosystem");
  refused(scene_with("<fill object=\"stone\"><layer from=\"5 cm\" to=\"1 cm\"/></fill>"), "from is above to");
  refused(scene_with("<fill object=\"stone\"><layer to=\"5 cm\"/></fill>"), "--bbox or --around", 1);
  refused("<details><tile>none.xml</tile><fill object=\"stone\"><layer to=\"1 m\"/></fill></details>", "none.xml", 1);
}

TEST_F(Details, AnEmptyFieldIsAnEmptyResult) {
  write(folder_ / "scene.xml", scene_with("<fill object=\"stone\"><constant value=\"0\"/></fill>"));
  const Outcome outcome = fill();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["instances"], 0);
}

TEST_F(Details, OptionsThatDoNotGoTogetherAreNamed) {
  EXPECT_EQ(fill({"--bbox", "0,0,1,1", "--around", "0,0"}).code, 2);
  EXPECT_EQ(fill({"--bbox", "1,0,0,1"}).code, 2);
  EXPECT_EQ(ghosttile({"edit", folder_ / "a.details"}).code, 2);
  EXPECT_EQ(ghosttile({"help", "laier"}).code, 2);
  EXPECT_THAT(ghosttile({"help", "laier"}).err, HasSubstr("did you mean \"layer\"?"));
}

TEST_F(Details, APartIsFilledAsTheWhole) {
  ASSERT_EQ(fill().code, 0);
  const Outcome part = fill({"--around", "1,1", "--radius", "0.5"}, "part.details");
  ASSERT_EQ(part.code, 0) << part.err;
  EXPECT_GT(part.json()["instances"], 5);
}

TEST(GhosttileDialect, ManualAndSchemaAreUpToDate) {
  EXPECT_EQ(read(source("configs/ghosttile.xsd")), ghosttile({"schema"}).out)
      << "run: ghosttile schema > configs/ghosttile.xsd";
  EXPECT_EQ(read(source("docs/ghosttile-dialect.md")), ghosttile({"help", "--manual"}).out)
      << "run: ghosttile help --manual > docs/ghosttile-dialect.md";
}

// With an ecosystem: rules, the ground, and stems, of which some stand just outside of the part.
TEST(DetailsExamples, APartOfTheValleyIsFilledAsALargerPart) {
  const Folder folder;
  ASSERT_EQ(silvasim({"run", source("configs/demo/ecosystem.xml"), "-o", folder / "valley.silva", "-q"}).code, 0);
  std::string text = read(source("configs/details/scenes/undergrowth.xml"));
  const std::string valley = "../../../build/demo/valley.silva";
  text.replace(text.find(valley), valley.size(), folder / "valley.silva");
  text.replace(text.find("../tiles/"), 9, source("configs/details/tiles/"));
  write(folder / "scene.xml", text);
  const auto rows = [&](const std::string& radius) {
    EXPECT_EQ(ghosttile({"fill", folder / "scene.xml", "--around", "571994,5726494", "--radius", radius, "-o",
                         folder / "x.details", "-q"})
                  .code,
              0);
    EXPECT_EQ(ghosttile({"export", folder / "x.details", "-o", folder / "x.csv", "-q"}).code, 0);
    std::set<std::string> all;
    std::istringstream lines(read(folder / "x.csv"));
    for (std::string line; std::getline(lines, line);) all.insert(line);
    return all;
  };
  const std::set<std::string> part = rows("3"), whole = rows("9");
  ASSERT_GT(part.size(), 500u);
  for (const std::string& row : part) ASSERT_TRUE(whole.contains(row)) << row;
}

// Every example is right by the schema and can be filled; the one that needs the demo valley gets it grown.
TEST(DetailsExamples, AreValidAndFill) {
  const Folder folder;
  const Outcome grown = silvasim({"run", source("configs/demo/ecosystem.xml"), "-o", folder / "valley.silva", "-q"});
  ASSERT_EQ(grown.code, 0) << grown.err;
  std::size_t scenes = 0;
  for (const char* kind : {"tiles", "scenes"}) {
    for (const auto& entry : std::filesystem::directory_iterator(source(std::string("configs/details/") + kind))) {
      const Outcome checked = program(
          {"xmllint", "--nonet", "--noout", "--schema", source("configs/ghosttile.xsd"), entry.path().string()});
      EXPECT_EQ(checked.code, 0) << checked.err;
      if (std::string(kind) == "tiles") continue;
      std::string text = read(entry.path().string());
      const std::string valley = "../../../build/demo/valley.silva";
      const bool in_valley = text.find(valley) != std::string::npos;
      if (in_valley) text.replace(text.find(valley), valley.size(), folder / "valley.silva");
      text.replace(text.find("../tiles/"), 9, source("configs/details/tiles/"));
      write(folder / "scene.xml", text);
      const Outcome filled = ghosttile({"fill", folder / "scene.xml", "--around", in_valley ? "571994,5726494" : "0,0",
                                        "--radius", "4", "-o", folder / "x.details", "--json", "-q"});
      ASSERT_EQ(filled.code, 0) << entry.path() << filled.err;
      EXPECT_GT(filled.json()["instances"], 0) << entry.path();
      ++scenes;
    }
  }
  EXPECT_GE(scenes, 6u);
}

}  // namespace
}  // namespace silvasim::cases
