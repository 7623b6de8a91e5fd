// Each command as its help promises it; exit codes; what errors look like.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/cases/program.h"

namespace silvasim::cases {
namespace {

using ::testing::HasSubstr;

// A small ecosystem, grown once for all tests.
class Commands : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new Folder;
    const Outcome outcome =
        silvasim({"run", scenario(), "-o", *folder_ / "e.silva", "--probabilities", "--json", "-q"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    report_ = new nlohmann::json(outcome.json());
  }
  static void TearDownTestSuite() {
    delete folder_;
    delete report_;
    folder_ = nullptr;
    report_ = nullptr;
  }
  static std::string scenario() { return source("configs/05-neighbours/ecosystem.xml"); }
  static std::string grown() { return *folder_ / "e.silva"; }

  static Folder* folder_;
  static nlohmann::json* report_;
};
Folder* Commands::folder_ = nullptr;
nlohmann::json* Commands::report_ = nullptr;

TEST_F(Commands, RunReportsWhatTheManualPromises) {
  for (const char* key :
       {"sites", "plants", "plants_by_species", "tiles", "corner_conflicts", "corner_removed", "neighbourhood_passes",
        "seconds", "peak_rss_bytes", "threads", "seed", "version", "config_sha256"}) {
    EXPECT_TRUE(report_->contains(key)) << key;
  }
  EXPECT_TRUE((*report_)["seconds"].contains("total"));
  EXPECT_GE((*report_)["neighbourhood_passes"].get<int>(), 1);
  EXPECT_EQ((*report_)["config_sha256"].get<std::string>().size(), 64u);
}

TEST_F(Commands, RunIsSilentOnStandardErrorWhenQuiet) {
  const Folder folder;
  EXPECT_EQ(silvasim({"run", scenario(), "-o", folder / "e.silva", "-q"}).err, "");
  EXPECT_NE(silvasim({"run", scenario(), "-o", folder / "e.silva"}).err, "");
}

TEST_F(Commands, InfoAgreesWithRun) {
  const auto info = silvasim({"info", grown(), "--json"}).json();
  EXPECT_EQ(info["plants"], (*report_)["plants"]);
  EXPECT_EQ(info["provenance"]["config_sha256"], (*report_)["config_sha256"]);
  EXPECT_THAT(silvasim({"info", grown()}).out, HasSubstr("layer    plants"));
}

TEST_F(Commands, ExportsHoldEveryPlant) {
  const Folder folder;
  const auto plants = (*report_)["plants"].get<long>();
  ASSERT_EQ(silvasim({"export", grown(), "--to", "csv", "-o", folder / "p.csv", "-q"}).code, 0);
  const std::string csv = read(folder / "p.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), plants + 1);
  ASSERT_EQ(silvasim({"export", grown(), "-o", folder / "p.geojson", "-q"}).code, 0);
  EXPECT_EQ(static_cast<long>(nlohmann::json::parse(read(folder / "p.geojson"))["features"].size()), plants);
  ASSERT_EQ(silvasim({"export", grown(), "-o", folder / "p.gpkg", "-q"}).code, 0);
  const Outcome ogr = program({"ogrinfo", "-so", "-al", folder / "p.gpkg"});
  EXPECT_THAT(ogr.out, HasSubstr("Feature Count: " + std::to_string(plants)));
}

TEST_F(Commands, PreviewDrawsMapsAndProbabilities) {
  const Folder folder;
  EXPECT_EQ(silvasim({"preview", grown(), "-o", folder / "m.png"}).code, 0);
  EXPECT_EQ(silvasim({"preview", grown(), "-o", folder / "m.svg", "--width", "800"}).code, 0);
  EXPECT_EQ(silvasim({"preview", grown(), "-o", folder / "p.png", "--layer", "probability", "--species",
                      (*report_)["plants_by_species"].items().begin().key()})
                .code,
            0);
  EXPECT_TRUE(std::filesystem::exists(folder / "m.pgw"));
  for (const char* const picture : {"s.png", "s.svg"}) {
    EXPECT_EQ(silvasim({"preview", grown(), "-o", folder / picture, "--layer", "suitability"}).code, 0);
  }
}

TEST_F(Commands, MapsOfThePlaceAreKeptWhereTheyAreAskedFor) {
  const Folder folder;
  const std::string example = source("configs/01-first-steps/ecosystem.xml");
  ASSERT_EQ(silvasim({"run", example, "-o", folder / "a.silva", "--tif", folder / "a.tif", "-q"}).code, 0);
  EXPECT_THAT(program({"gdalinfo", folder / "a.tif"}).out, HasSubstr("Description = "));
  ASSERT_EQ(silvasim({"export", folder / "a.silva", "-o", folder / "b.tif", "-q"}).code, 0);
  EXPECT_EQ(read(folder / "a.tif"), read(folder / "b.tif"));
  ASSERT_EQ(silvasim({"run", example, "-o", folder / "c.silva", "-q"}).code, 0);
  for (const Outcome& outcome :
       {silvasim({"export", folder / "c.silva", "-o", folder / "c.tif", "-q"}),
        silvasim({"preview", folder / "c.silva", "-o", folder / "c.png", "--layer", "suitability", "-q"})}) {
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("simulate it again with: silvasim run ... --probabilities"));
  }
}

TEST_F(Commands, ExplainTellsASentence) {
  const auto extent = (*report_)["extent"];
  const double x = (extent["west"].get<double>() + extent["east"].get<double>()) / 2,
               y = (extent["south"].get<double>() + extent["north"].get<double>()) / 2;
  const std::string at = std::to_string(x) + "," + std::to_string(y);
  const auto json = silvasim({"explain", scenario(), "--at", at, "--json", "-q"}).json();
  const auto& layer = json["layers"][0];
  EXPECT_THAT(layer["sentence"].get<std::string>(), HasSubstr("stands here"));
  EXPECT_FALSE(layer["species"].empty());
  EXPECT_THAT(silvasim({"explain", scenario(), "--at", at, "-q"}).out, HasSubstr("so far"));
  const Outcome outside = silvasim({"explain", scenario(), "--at", "-1e7,0", "-q"});
  EXPECT_EQ(outside.code, 1);
  EXPECT_THAT(outside.err, HasSubstr("lies outside the scene"));
}

TEST_F(Commands, TheSeedChangesThePlants) {
  const Folder folder;
  ASSERT_EQ(silvasim({"run", scenario(), "-o", folder / "a.silva", "--seed", "1", "-q"}).code, 0);
  ASSERT_EQ(silvasim({"run", scenario(), "-o", folder / "b.silva", "--seed", "2", "-q"}).code, 0);
  EXPECT_NE(read(folder / "a.silva"), read(folder / "b.silva"));
}

TEST(CommandLine, WrongUseIsExitCodeTwo) {
  EXPECT_EQ(silvasim({}).code, 2);
  EXPECT_EQ(silvasim({"grow"}).code, 2);
  EXPECT_EQ(silvasim({"run"}).code, 2);
  EXPECT_EQ(silvasim({"run", "x.xml", "--threads", "0"}).code, 2);
  EXPECT_EQ(silvasim({"explain", "x.xml", "--at", "5"}).code, 2);
  EXPECT_EQ(silvasim({"help", "NoSuchElement"}).code, 2);
  EXPECT_THAT(silvasim({"help", "MinMaxEvaluatr"}).err, HasSubstr("did you mean \"MinMaxEvaluator\"?"));
}

TEST(CommandLine, HelpAndVersionAreExitCodeZero) {
  EXPECT_EQ(silvasim({"--help"}).code, 0);
  EXPECT_EQ(silvasim({"run", "--help"}).code, 0);
  EXPECT_THAT(silvasim({"--version"}).out, HasSubstr("silvasim "));
  EXPECT_THAT(silvasim({"help", "MinMaxEvaluator"}).out, HasSubstr("optimum"));
  EXPECT_THAT(silvasim({"help"}).out, HasSubstr("<GradientEvaluator>"));
}

TEST(CommandLine, MissingFilesAreOneLine) {
  const Outcome outcome = silvasim({"run", "no-such.xml"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.err, "silvasim: error: cannot read \"no-such.xml\": No such file or directory\n");
  EXPECT_EQ(silvasim({"info", "no-such.silva"}).code, 1);
}

TEST(CommandLine, ConfigurationErrorsAreExitCodeTwoWithPlaces) {
  const Folder folder;
  write(folder / "ecosystem.xml", "<ecosystem>\n  <tiles sid=\"5\"/>\n</ecosystem>");
  write(folder / "plants.xml", "<plants><plant name=\"oak\"/></plants>");
  for (const char* command : {"validate", "run"}) {
    const Outcome outcome = silvasim({command, folder / "ecosystem.xml"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err,
                HasSubstr("ecosystem.xml:2:10: error: <tiles> has no attribute \"sid\"; did you mean \"side\"?"));
  }
  const auto json = silvasim({"validate", folder / "ecosystem.xml", "--json"}).json();
  EXPECT_FALSE(json["valid"].get<bool>());
  EXPECT_EQ(json["errors"][0]["line"], 2);
}

TEST(CommandLine, OutputsThatCannotBeAreRefusedBeforeTheWork) {
  const Folder folder;
  const std::string scenario = source("configs/01-first-steps/ecosystem.xml");
  EXPECT_EQ(silvasim({"run", scenario, "-o", folder.path().string(), "-q"}).code, 1);
  EXPECT_EQ(silvasim({"run", scenario, "-o", folder / "no/such/folder.silva", "-q"}).code, 1);
  EXPECT_EQ(silvasim({"run", scenario, "-o", "/dev/full", "-q"}).code, 1);
  EXPECT_EQ(silvasim({"run", scenario, "-o", folder / "same.png", "--png", folder / "same.png", "-q"}).code, 2);
  // An input as output: the file stays as it was.
  write(folder / "ecosystem.xml", read(scenario));
  write(folder / "plants.xml", read(source("configs/01-first-steps/plants.xml")));
  std::filesystem::create_directories(folder.path() / "x");
  const std::string before = read(folder / "plants.xml");
  EXPECT_NE(silvasim({"run", folder / "ecosystem.xml", "-o", folder / "plants.xml", "-q"}).code, 0);
  EXPECT_EQ(read(folder / "plants.xml"), before);
}

TEST_F(Commands, AnEcosystemIsNotOverwrittenByWhatIsMadeOfIt) {
  const Folder folder;
  const std::string before = read(grown());
  write(folder / "w.silva", before);
  write(folder / "w.png", before);
  EXPECT_NE(silvasim({"export", folder / "w.silva", "--to", "csv", "-o", folder / "w.silva", "-q"}).code, 0);
  EXPECT_NE(silvasim({"preview", folder / "w.png", "-o", folder / "w.png", "-q"}).code, 0);
  EXPECT_EQ(read(folder / "w.silva"), before);
  EXPECT_EQ(read(folder / "w.png"), before);
}

// A map brings files along; they must not fall on each other, nor on what belongs to a data field.
TEST(CommandLine, FilesBesideAMapAreOutputsToo) {
  const Folder folder;
  const std::string example = source("configs/01-first-steps/ecosystem.xml");
  EXPECT_EQ(
      silvasim({"run", example, "-o", folder / "a.silva", "--png", folder / "a.png", "--csv", folder / "a.pgw", "-q"})
          .code,
      2);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.silva"));
}

// Whoever reads the log may have gone, or its disk be full: the work and its exit code stay.
TEST_F(Commands, WhatCannotBeSaidDoesNotEndTheWork) {
  const Folder folder;
  const std::string run = std::string(SILVA_BINARY_DIR) + "/silvasim run '" + scenario() + "' -o '" +
                          (folder / "a.silva") + "' 2>/dev/full";
  EXPECT_EQ(program({"sh", "-c", run}).code, 0);
  EXPECT_EQ(program({"sh", "-c", std::string(SILVA_BINARY_DIR) + "/silvasim info nowhere 2>/dev/full"}).code, 1);
  EXPECT_EQ(program({"sh", "-c", std::string(SILVA_BINARY_DIR) + "/silvasim grow 2>&-"}).code, 2);
}

TEST(CommandLine, ADamagedEcosystemIsRefused) {
  const Folder folder;
  write(folder / "bad.silva", "not an ecosystem file at all");
  const Outcome outcome = silvasim({"info", folder / "bad.silva"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("bad.silva"));
}

}  // namespace
}  // namespace silvasim::cases
