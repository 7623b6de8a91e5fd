// silvavis fly: flights as users ask for them, and what they get wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/cases/silvavis_program.h"

namespace silvasim::cases {
namespace {

using ::testing::HasSubstr;

constexpr const char* example = "01-first-steps";

// A flight of five frames over the example's middle; `more` goes into <path>.
std::string path_text(const std::string& more = "") {
  const auto extent = silvasim({"info", grown(example), "--json"}).json()["extent"];
  const double x = extent["west"], y = extent["south"];
  const double width = extent["east"].get<double>() - x, height = extent["north"].get<double>() - y;
  const auto point = [&](double u, double v) {
    return "<point x=\"" + std::to_string(x + u * width) + "\" y=\"" + std::to_string(y + v * height) +
           "\" height=\"30\" above=\"ground\"/>\n";
  };
  return "<path fps=\"2\" duration=\"2 s\" " + more + ">\n" + point(0.1, 0.2) + point(0.5, 0.4) + point(0.9, 0.3) +
         "</path>";
}

std::vector<std::string> flight(const Folder& folder, const std::string& output, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments{"fly", grown(example), folder / "path.xml", "-o", output, "--spp", "2"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::string error_of(const std::vector<std::string>& arguments, int code) {
  const Outcome outcome = quick(arguments);
  EXPECT_EQ(outcome.code, code) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  return outcome.err;
}

TEST(Fly, FramesDependNeitherOnThreadsNorOnParts) {
  const Folder one, two, parts;
  write(one / "path.xml", path_text());
  ASSERT_EQ(quick(flight(one, one / "%04d.png", {"--threads", "1"})).code, 0);
  EXPECT_EQ(one.files(),
            (std::vector<std::string>{"0001.png", "0002.png", "0003.png", "0004.png", "0005.png", "path.xml"}));
  ASSERT_EQ(quick(flight(one, two / "%04d.png", {"--threads", "2"})).code, 0);
  ASSERT_EQ(quick(flight(one, parts / "%04d.png", {"--frames", "4-5"})).code, 0);
  EXPECT_EQ(parts.files(), (std::vector<std::string>{"0004.png", "0005.png"}));
  ASSERT_EQ(quick(flight(one, parts / "%04d.png", {"--frames", "1-3"})).code, 0);
  for (const std::string& name : two.files()) {
    EXPECT_EQ(read(one / name), read(two / name)) << name;
    EXPECT_EQ(read(one / name), read(parts / name)) << name;
  }
  EXPECT_NE(read(one / "0001.png"), read(one / "0005.png"));
}

TEST(Fly, WhatIsThereIsNeverSkippedSilently) {
  const Folder folder;
  write(folder / "path.xml", path_text());
  write(folder / "2.png", "mine");
  EXPECT_THAT(error_of(flight(folder, folder / "%d.png"), 1), HasSubstr("1 of the frames 1 to 5 are there already"));
  EXPECT_EQ(read(folder / "2.png"), "mine");
  const Outcome resumed = silvavis({"fly", grown(example), folder / "path.xml", "-o", folder / "%d.png", "--size",
                                    "64x36", "--spp", "2", "--triangles", "12000", "--resume", "--json"});
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_EQ(resumed.json()["written"], 4);
  EXPECT_EQ(resumed.json()["kept"], 1);
  EXPECT_EQ(read(folder / "2.png"), "mine");
  ASSERT_EQ(quick(flight(folder, folder / "%d.png", {"--overwrite", "--frames", "2"})).code, 0);
  EXPECT_NE(read(folder / "2.png"), "mine");
  EXPECT_EQ(quick(flight(folder, folder / "%d.png", {"--overwrite", "--resume"})).code, 2);
}

TEST(Fly, TheSunMayMove) {
  const Folder folder;
  write(folder / "path.xml", path_text());
  ASSERT_EQ(quick(flight(folder, folder / "still%d.png", {"--sun", "2026-06-21T10:00"})).code, 0);
  ASSERT_EQ(quick(flight(folder, folder / "moves%d.png",
                         {"--sun", "2026-06-21T10:00", "--sun-to", "2026-06-21T10:00", "--frames", "5"}))
                .code,
            0);
  EXPECT_EQ(read(folder / "still5.png"), read(folder / "moves5.png"));
  ASSERT_EQ(quick(flight(folder, folder / "moves%d.png",
                         {"--sun", "2026-06-21T10:00", "--sun-to", "2026-06-21T18:00", "--frames", "5", "--overwrite"}))
                .code,
            0);
  EXPECT_NE(read(folder / "still5.png"), read(folder / "moves5.png"));
  EXPECT_THAT(
      error_of(flight(folder, folder / "x%d.png", {"--sun-direction", "180,40", "--sun-to", "2026-06-21T18:00"}), 2),
      HasSubstr("--sun-to goes with --sun"));
}

TEST(Fly, OutputsThatCannotBe) {
  const Folder folder;
  write(folder / "path.xml", path_text());
  EXPECT_THAT(error_of(flight(folder, folder / "film.png"), 2), HasSubstr("write it like frames/%04d.png"));
  EXPECT_THAT(error_of(flight(folder, folder / "%d-%d.png"), 2), HasSubstr("two frame numbers"));
  EXPECT_THAT(error_of(flight(folder, folder / "%5d.png"), 2), HasSubstr("%01d to %09d"));
  EXPECT_THAT(error_of(flight(folder, folder / "none/%d.png"), 1), HasSubstr("there is no folder"));
  EXPECT_THAT(error_of(flight(folder, folder / "%d.gif"), 1), HasSubstr("ends in .exr, .png, .jpg or .tif"));
  EXPECT_THAT(error_of(flight(folder, folder / "%d.png", {"--frames", "3-9"}), 2), HasSubstr("a part of 1-5"));
  EXPECT_THAT(error_of(flight(folder, folder / "%d.png", {"--fps", "nan"}), 2), HasSubstr("--fps"));
  // An output that is an input, by another name.
  std::filesystem::create_hard_link(grown(example), folder / "3.png");
  const std::string before = read(grown(example));
  EXPECT_THAT(error_of(flight(folder, folder / "%d.png", {"--overwrite"}), 1), HasSubstr("it is also an input"));
  EXPECT_EQ(read(grown(example)), before);
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"3.png", "path.xml"}));
}

TEST(Fly, WhatIsWrongIsSaidBeforeModelsAreMade) {
  const Folder folder;
  write(folder / "path.xml", path_text());
  write(folder / "wrong.xml", path_text("spee=\"3\""));
  write(folder / "2.png", "mine");
  const auto refused = [&](const std::string& path, const std::vector<std::string>& more, const char* what, int code) {
    std::vector<std::string> arguments{"fly", grown(example), folder / path, "-o", folder / "%d.png"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = silvavis(arguments);
    EXPECT_EQ(outcome.code, code);
    EXPECT_THAT(outcome.err, testing::AllOf(HasSubstr(what), testing::Not(HasSubstr("models"))));
  };
  refused("wrong.xml", {}, "has no attribute \"spee\"", 2);
  refused("path.xml", {}, "1 of the frames 1 to 5 are there already", 1);
  refused("path.xml", {"--frames", "3-9"}, "a part of 1-5", 2);
  refused("path.xml", {"--sun-to", "yesterday"}, "--sun-to \"yesterday\"", 2);
  refused("path.xml", {"--size", "10"}, "--size", 2);
  refused("none.xml", {}, "none.xml", 1);
}

TEST(Fly, PathsThatCannotBe) {
  const Folder folder;
  const auto error = [&](const std::string& name, const std::string& text, int code = 2) {
    write(folder / name, text);
    return error_of({"fly", grown(example), folder / name, "-o", folder / "%d.png"}, code);
  };
  EXPECT_THAT(error("a.xml", "<path><point x=\"1\" y=\"2\" height=\"3\"/></path>"),
              HasSubstr("a.xml:1:1: error: <path> needs 2 of <point>, has only 1"));
  EXPECT_THAT(error("a.xml", "<path fsp=\"3\">\n<point x=\"nan\" y=\"2\" height=\"3\"/><point/></path>"),
              testing::AllOf(HasSubstr("a.xml:1:7: error: <path> has no attribute \"fsp\"; did you mean \"fps\"?"),
                             HasSubstr("a.xml:2:8: error: <point> x: \"nan\" is no finite number"),
                             HasSubstr("a.xml:2:34: error: <point> needs")));
  const std::string two = "<point x=\"1\" y=\"2\" height=\"3\" time=\"2\"/><point x=\"5\" y=\"2\" height=\"3\"";
  EXPECT_THAT(error("a.xml", "<path>" + two + " time=\"2\"/></path>"), HasSubstr("not later"));
  EXPECT_THAT(error("a.xml", "<path>" + two + "/></path>"), HasSubstr("needs the attribute \"time\""));
  EXPECT_THAT(error("a.xml", "<path duration=\"9 s\">" + two + " time=\"3\"/></path>"), HasSubstr("one is enough"));
  EXPECT_THAT(error("a.geojson", R"({"type":"Polygon","coordinates":[[[0,0],[1,0],[1,1],[0,0]]]})"),
              HasSubstr("it holds Polygon; a path is one LineString"));
  EXPECT_THAT(error("a.geojson", R"({"type":"LineString","coordinates":[[0,0,5]]})"), HasSubstr("one point"));
  EXPECT_THAT(error("a.geojson", R"({"type":"LineString","coordinates":[[0,0],[1,1]]})"),
              HasSubstr("--height-above-ground"));
  EXPECT_THAT(error("a.geojson", "{\n\"type\":\"LineString\",\"coordinates\":[[NaN,0],[1,1]]}"),
              HasSubstr("a.geojson:2:"));
  EXPECT_THAT(error("a.geojson", std::string(100000, '[')), HasSubstr("not well-formed JSON"));
  EXPECT_THAT(error("a.geojson", ""), HasSubstr("not well-formed JSON"));
  EXPECT_THAT(error("a.txt", ""), HasSubstr("should end in .xml, .geojson or .json"));
}

// Ctrl-C between and within frames: what has a frame's name is whole, and --resume ends the work.
TEST(Fly, AnInterruptionLeavesWholeFramesOnly) {
  const Folder folder, whole;
  write(folder / "path.xml", path_text());
  const std::string binary = std::string(SILVA_BINARY_DIR) + "/silvavis", out = folder / "%d.png";
  const pid_t child = fork();
  if (child == 0) {
    execl(binary.c_str(), "silvavis", "fly", grown(example).c_str(), (folder / "path.xml").c_str(), "-o", out.c_str(),
          "--size", "240x135", "--spp", "16", "--error", "0", "--triangles", "12000", "-q", nullptr);
    _exit(127);
  }
  for (int i = 0; i < 3000 && !std::filesystem::exists(folder / "2.png"); ++i) usleep(20000);
  kill(child, SIGINT);
  int status = 0;
  waitpid(child, &status, 0);
  const std::vector<std::string> files = folder.files();
  if (!(WIFEXITED(status) && WEXITSTATUS(status) == 0)) {
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 130) << status;
    EXPECT_LT(files.size(), 6u);
  }
  const std::vector<std::string> settings{"--size", "240x135",     "--spp", "16", "--error",
                                          "0",      "--triangles", "12000", "-q"};
  const auto fly = [&](const std::string& output, const char* more) {
    std::vector<std::string> arguments{"fly", grown(example), folder / "path.xml", "-o", output, more};
    arguments.insert(arguments.end(), settings.begin(), settings.end());
    return silvavis(arguments).code;
  };
  ASSERT_EQ(fly(out, "--resume"), 0);
  ASSERT_EQ(fly(whole / "%d.png", "--resume"), 0);
  for (const std::string& file : files) EXPECT_NE(file[0], '.') << file;
  for (const std::string& name : whole.files()) EXPECT_EQ(read(folder / name), read(whole / name)) << name;
}

}  // namespace
}  // namespace silvasim::cases
