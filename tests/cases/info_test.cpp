// silvasim info with files whose words are meant to hurt.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "silvasim/ecosystem/file.h"
#include "tests/cases/program.h"

namespace silvasim::cases {
namespace {

using testing::HasSubstr;
using testing::Not;

ecosystem::Ecosystem tiny() {
  ecosystem::Ecosystem ecosystem;
  ecosystem.name = "Al\x1b[2Jps";
  ecosystem.extent = {0, 0, 10, 10};
  ecosystem::Layer layer;
  layer.name =
      "tr\x07"
      "ees";
  layer.north_west = {0, 10};
  ecosystem::Species& species = layer.species.emplace_back();
  species.name = "Fa\x1b[31mgus";
  species.common_name = "\xC2\x9B";
  species.most_scale = 1;
  layer.tile_set.side_m = 10;
  layer.tile_set.most_radius_m = 1;
  layer.tile_set.colours = layer.tile_set.variants = 1;
  layer.tile_set.tiles.resize(1);
  layer.tiling.columns = layer.tiling.rows = 1;
  layer.tiling.tiles = {0};
  ecosystem.layers.push_back(layer);
  return ecosystem;
}

TEST(Info, NamesCannotCommandTheTerminal) {
  const Folder folder;
  ecosystem::write(tiny(), folder / "e.silva", {}, {});
  const Outcome text = silvasim({"info", folder / "e.silva"});
  EXPECT_EQ(text.code, 0);
  for (const char* control : {"\x1b", "\x07", "\xC2\x9B"}) EXPECT_THAT(text.out, Not(HasSubstr(control)));
  EXPECT_THAT(text.out, HasSubstr("Al\uFFFD[2Jps"));
}

TEST(Info, ProvenanceOfOtherTypesIsShownAsItIs) {
  const Folder folder;
  ecosystem::Ecosystem ecosystem = tiny();
  ecosystem.provenance_json = R"({"version":3,"seed":[1],"config_sha256":7})";
  ecosystem::write(ecosystem, folder / "e.silva", {}, {});
  EXPECT_THAT(silvasim({"info", folder / "e.silva"}).out, HasSubstr("made by  silvasim 3, seed ?, configuration 7"));
  EXPECT_EQ(silvasim({"info", folder / "e.silva", "--json"}).json()["provenance"]["version"], 3);
}

}  // namespace
}  // namespace silvasim::cases
