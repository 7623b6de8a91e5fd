// The colours of the tile set (A1).
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <tuple>

#include "silvasim/tiles/fill.h"

namespace silvasim::tiles {
namespace {

config::TileSettings with(int colours, int variants) {
  config::TileSettings settings;
  settings.colours = colours;
  settings.variants = variants;
  return settings;
}

TEST(Colours, ThreeAndTwoAreThePapersEighteenTiles) {
  const TileSet set = empty_tiles(with(3, 2));
  ASSERT_EQ(set.tiles.size(), 18u);
  for (int n = 0; n < 3; ++n) {
    for (int w = 0; w < 3; ++w) {
      for (int k = 0; k < 2; ++k) {
        const EdgeColours c = set.tiles[static_cast<std::size_t>((n * 3 + w) * 2 + k)].colours;
        EXPECT_EQ(c.north, n);
        EXPECT_EQ(c.west, w);
        EXPECT_EQ(c.south, (n + 1 + k) % 3);
        EXPECT_EQ(c.east, (w + 1 + ((k + n) & 1)) % 3);
      }
    }
  }
}

TEST(Colours, EveryPairHasItsVariantsAndEveryColourItsShare) {
  for (int colours = 3; colours <= 9; ++colours) {
    for (int variants = 2; variants < colours; ++variants) {
      SCOPED_TRACE(std::to_string(colours) + " colours, " + std::to_string(variants) + " variants");
      const TileSet set = empty_tiles(with(colours, variants));
      std::map<std::pair<int, int>, std::set<std::pair<int, int>>> ends;
      std::map<int, int> north, east, south, west;
      for (const Tile& tile : set.tiles) {
        const EdgeColours c = tile.colours;
        EXPECT_NE(c.north, c.south);
        EXPECT_NE(c.west, c.east);
        ends[{c.north, c.west}].insert({c.south, c.east});
        ++north[c.north], ++east[c.east], ++south[c.south], ++west[c.west];
      }
      EXPECT_EQ(ends.size(), static_cast<std::size_t>(colours * colours));
      for (const auto& [pair, different] : ends) EXPECT_EQ(different.size(), static_cast<std::size_t>(variants));
      for (const auto& side : {north, east, south, west}) {
        ASSERT_EQ(side.size(), static_cast<std::size_t>(colours));
        for (const auto& [colour, count] : side) EXPECT_EQ(count, colours * variants) << "colour " << colour;
      }
    }
  }
}

}  // namespace
}  // namespace silvasim::tiles
