// Every example grows, is valid by the schema, and means what its README says.
#include <gtest/gtest.h>

#include <iostream>

#include "silvasim/ecosystem/file.h"
#include "tests/cases/program.h"

namespace silvasim::cases {
namespace {

TEST(Examples, ThereAreSome) { EXPECT_GE(examples().size(), 8u); }

TEST(Examples, EachIsValidAndXmllintAgrees) {
  for (const auto& path : examples()) {
    const Outcome outcome = silvasim({"validate", path.string()});
    EXPECT_EQ(outcome.code, 0) << path << "\n" << outcome.err;
    for (const char* name : {"ecosystem.xml", "plants.xml"}) {
      const auto file = path.parent_path() / name;
      if (!std::filesystem::exists(file)) continue;
      const Outcome lint =
          program({"xmllint", "--nonet", "--noout", "--schema", source("configs/silva.xsd"), file.string()});
      EXPECT_EQ(lint.code, 0) << lint.err;
    }
  }
}

TEST(Examples, TheShippedSchemaIsTheOneThatIsPrinted) {
  EXPECT_EQ(read(source("configs/silva.xsd")), silvasim({"schema"}).out) << "run: silvasim schema > configs/silva.xsd";
}

TEST(Examples, TheManualPageIsTheOneThatIsPrinted) {
  EXPECT_EQ(read(source("docs/dialect.md")), silvasim({"help", "--manual"}).out)
      << "run: silvasim help --manual > docs/dialect.md";
}

TEST(Examples, EachGrowsPlantsOfMostOfItsSpecies) {
  for (const auto& path : examples()) {
    const Folder folder;
    const Outcome outcome = silvasim({"run", path.string(), "-o", folder / "e.silva", "--png", folder / "e.png",
                                      "--svg", folder / "e.svg", "--json", "-q"});
    ASSERT_EQ(outcome.code, 0) << path << "\n" << outcome.err;
    const auto json = outcome.json();
    EXPECT_GT(json["plants"].get<int>(), 100) << path;
    int grown = 0, species = 0;
    for (const auto& [name, count] : json["plants_by_species"].items()) {
      ++species;
      grown += count.get<int>() > 0;
    }
    EXPECT_GE(grown * 10, species * 8) << path << ": only " << grown << " of " << species << " species stand";

    // What the report says and what the file holds are the same.
    const ecosystem::Ecosystem e = ecosystem::read(folder / "e.silva");
    std::uint64_t standing = 0;
    for (const auto& layer : e.layers) {
      for (const auto plant : layer.plants) standing += plant != ecosystem::no_plant;
    }
    EXPECT_EQ(standing, json["plants"].get<std::uint64_t>());
    EXPECT_GT(std::filesystem::file_size(folder / "e.png"), 10000u);
    EXPECT_GT(std::filesystem::file_size(folder / "e.svg"), 10000u);
  }
}

}  // namespace
}  // namespace silvasim::cases
