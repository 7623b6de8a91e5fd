// silvavis view, by scripts and without a screen: what keys and mouse do, and that what it saves is what render gives.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <regex>

#include "silvasim/ecosystem/file.h"
#include "silvavis/image/compare.h"
#include "silvavis/image/file.h"
#include "tests/cases/silvavis_program.h"

namespace silvasim::cases {
namespace {

using silvavis::V3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string example = "02-elevation";

class View : public ::testing::Test {
 protected:
  void SetUp() override { setenv("SDL_VIDEODRIVER", "dummy", 1); }

  // The scene's middle from 60 m above, looking north and down.
  std::vector<std::string> from_above() {
    const auto e = ecosystem::read(grown(example));
    const double x = (e.extent.west + e.extent.east) / 2, y = (e.extent.south + e.extent.north) / 2;
    const auto text = [](double a, double b, const std::string& h) {
      return std::to_string(a) + "," + std::to_string(b) + "," + h;
    };
    return {"--eye", text(x, y - 80, "+60"), "--look-at", text(x, y, "+0")};
  }

  Outcome run(const std::string& command, const std::vector<std::string>& more, const std::string& samples = "3") {
    std::vector<std::string> arguments{command, grown(example), "--spp", samples};
    for (const auto& list : {from_above(), more}) arguments.insert(arguments.end(), list.begin(), list.end());
    return quick(arguments);
  }

  Outcome play(const std::string& script, std::vector<std::string> more = {}, const std::string& samples = "3") {
    write(folder_ / "script.txt", script);
    more.insert(more.end(), {"--script", folder_ / "script.txt", "-o", folder_ / "v-%d.exr", "--json"});
    return run("view", more, samples);
  }

  static V3d place(const nlohmann::json& json) {
    V3d p;
    EXPECT_EQ(std::sscanf(json.get<std::string>().c_str(), "%lf,%lf,%lf", &p.x, &p.y, &p.z), 3);
    return p;
  }

  const Folder folder_;
};

TEST_F(View, SavesWhatRenderGives) {
  const Outcome outcome = play("wait\npress P   # full\npress L\nwait\npress P\n");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  ASSERT_EQ(run("render", {"-o", folder_ / "a.exr"}).code, 0);
  EXPECT_EQ(read(folder_ / "v-1.exr"), read(folder_ / "a.exr"));
  ASSERT_EQ(run("render", {"--lod", "off", "-o", folder_ / "b.exr"}).code, 0);
  EXPECT_EQ(read(folder_ / "v-2.exr"), read(folder_ / "b.exr"));
  EXPECT_NE(read(folder_ / "a.exr"), read(folder_ / "b.exr"));
  EXPECT_FALSE(outcome.json()["levels"]);
  EXPECT_EQ(outcome.json()["saved"].size(), 2u);
  EXPECT_EQ(outcome.json()["pictures"]["first"]["count"], 2);
}

TEST_F(View, MovesTheSun) {
  const Outcome outcome =
      play("press T\npress T\npress T\npress shift+T\nwait\npress P\n", {"--sun", "2026-04-02T23:20"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  ASSERT_EQ(run("render", {"--sun", "2026-04-03T00:20", "-o", folder_ / "a.exr"}).code, 0);
  EXPECT_EQ(read(folder_ / "v-1.exr"), read(folder_ / "a.exr"));
  write(folder_ / "still.txt", "press T\n");
  const Outcome still = silvavis({"view", grown(example), "--sun-direction", "90,20", "--script", folder_ / "still.txt",
                                  "--triangles", "12000", "--size", "64x36"});
  EXPECT_EQ(still.code, 0);
  EXPECT_THAT(still.err, HasSubstr("begin with --sun"));
}

TEST_F(View, FliesAndPrintsTheCameraThatRenderTakes) {
  const auto e = ecosystem::read(grown(example));
  const auto begin = play("wait 1\n").json();
  // A second to the right, at half of 60 m a second.
  const auto right = play("hold D 10\n").json();
  const V3d way = place(right["eye"]) - place(begin["eye"]);
  EXPECT_NEAR(way.y, 0, 0.02);
  EXPECT_NEAR(way.z, 0, 0.02);
  EXPECT_GT(way.x, 20);
  EXPECT_LT(way.x, 40);
  // Down to the ground, and no farther.
  const V3d down = place(play("hold Q 300\n").json()["eye"]);
  EXPECT_NEAR(down.z, ecosystem::height_at(e.terrain, {down.x, down.y}) + 0.5, 0.6);
  EXPECT_LT(down.z, place(begin["eye"]).z - 50);
  // What turned and came back looks at the same point again.
  const auto turned = play("hold Left 5\nhold Right 5\ndrag 40 -10\ndrag -40 10\n").json();
  EXPECT_LT((place(turned["eye"]) - place(begin["eye"])).length(), 0.02);

  const Outcome flown = play("hold WE 4\ndrag 10 2\npress C\nwait\npress P\npress R\npress C\n", {}, "16");
  ASSERT_EQ(flown.code, 0) << flown.err;
  const auto cameras = flown.json()["cameras"];
  ASSERT_EQ(cameras.size(), 2u);
  write(folder_ / "c.xml", "<cameras>" + cameras[0].get<std::string>() + cameras[1].get<std::string>() + "</cameras>");
  const auto render = [&](const std::string& name) {
    EXPECT_EQ(quick({"render", grown(example), "--camera", folder_ / "c.xml#" + name, "--spp", "16", "-o",
                     folder_ / (name + ".exr")})
                  .code,
              0);
    return silvavis::image::read(folder_ / (name + ".exr"));
  };
  const auto saved = silvavis::image::read(folder_ / "v-1.exr");
  const double alike = silvavis::image::compare(render("view-1"), saved).rmse;
  EXPECT_LT(alike, 0.001);
  EXPECT_GT(silvavis::image::compare(render("view-2"), saved).rmse, 3 * alike + 0.01) << "R did not return";
  EXPECT_EQ(place(flown.json()["eye"]), place(begin["eye"]));
}

TEST_F(View, FollowsTheWindow) {
  ASSERT_EQ(play("wait 2\nresize 50 40\nwait\npress P\n").code, 0);
  const auto picture = silvavis::image::read(folder_ / "v-1.exr");
  EXPECT_EQ(picture.width, 50);
  EXPECT_EQ(picture.height, 40);
}

TEST_F(View, EndsByItself) {
  const Outcome three = run("view", {"--frames", "3", "--json", "--error", "0"}, "60000");
  ASSERT_EQ(three.code, 0) << three.err;
  EXPECT_EQ(three.json()["pictures"]["first"]["count"], 1);
  EXPECT_EQ(three.json()["pictures"]["refined"]["count"], 2);
  EXPECT_EQ(run("view", {"--frames", "1000000"}, "1").code, 0) << "it does not end with the finished picture";
  EXPECT_EQ(play("press Esc\nhold W 1000000\n").code, 0);
  write(folder_ / "long.txt", "hold A 1000000\n");
  std::vector<std::string> command{"timeout", "--preserve-status", "-s", "INT", "3"};
  command.push_back(std::string(SILVA_BINARY_DIR) + "/silvavis");
  for (const std::string& word : {std::string("view"), grown(example), std::string("--script"), folder_ / "long.txt",
                                  std::string("--triangles"), std::string("12000")})
    command.push_back(word);
  const Outcome interrupted = program(command);
  EXPECT_EQ(interrupted.code, 130) << interrupted.err;
}

TEST_F(View, SaysWhatIsWrong) {
  const Outcome script = play("wait 3\nhold W\njump 3\nwait x\npress ?\nwheel 1 2\n");
  EXPECT_EQ(script.code, 2);
  EXPECT_THAT(script.err, HasSubstr("script.txt:2: error: \"hold W\" should read like: hold WE 10"));
  EXPECT_THAT(script.err, HasSubstr("script.txt:3: error: there is no step \"jump\""));
  for (const char* line : {":4:", ":5:", ":6:"}) EXPECT_THAT(script.err, HasSubstr(std::string("script.txt") + line));
  EXPECT_EQ(run("view", {"--frames", "1", "-o", folder_ / "no-number.png"}).code, 2);
  EXPECT_EQ(run("view", {"--frames", "1", "-o", folder_ / "none/v-%d.png"}).code, 1);

  unsetenv("SDL_VIDEODRIVER");
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  const Outcome blind = run("view", {"--frames", "1"});
  EXPECT_EQ(blind.code, 1);
  EXPECT_THAT(blind.err, HasSubstr("silvavis: error: there is no display to open a window on"));
  EXPECT_EQ(std::count(blind.err.begin(), blind.err.end(), '\n'), 1) << blind.err;
}

}  // namespace
}  // namespace silvasim::cases
