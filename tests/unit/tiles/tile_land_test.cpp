// Tilings: edges agree, tiles are equally frequent, bytes depend on the key alone.
#include "silvasim/tiles/tile_land.h"

#include <gtest/gtest.h>

#include <set>

#include "silvasim/base/error.h"
#include "silvasim/tiles/fill.h"

namespace silvasim::tiles {
namespace {

TileSet set_of(int colours, int variants) {
  config::TileSettings settings;
  settings.colours = colours;
  settings.variants = variants;
  return empty_tiles(settings);
}

TEST(TileLand, TouchingEdgesAgree) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    for (const auto& [colours, variants] : {std::pair{3, 2}, {4, 2}, {4, 3}, {5, 4}, {6, 2}, {6, 5}, {16, 15}}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", colours " + std::to_string(colours));
      const TileSet set = set_of(colours, variants);
      const Tiling land = tile_land(set, 23, 17, seed);
      for (int row = 0; row < land.rows; ++row) {
        for (int column = 0; column < land.columns; ++column) {
          ASSERT_LT(land.at(column, row), set.tiles.size());
          const EdgeColours here = set.tiles[land.at(column, row)].colours;
          if (row > 0) {
            ASSERT_EQ(here.north, set.tiles[land.at(column, row - 1)].colours.south);
          }
          if (column > 0) {
            ASSERT_EQ(here.west, set.tiles[land.at(column - 1, row)].colours.east);
          }
        }
      }
    }
  }
}

TEST(TileLand, TilesAreEquallyFrequent) {
  // Tiles of a row are dependent, so chi-square is larger than for independent draws: about 1 a degree of freedom if they
  // were, and below 2 for tilings of this size; a set with a tile twice as frequent would give hundreds.
  for (const auto& [colours, variants] : {std::pair{3, 2}, {4, 3}, {6, 2}}) {
    const TileSet set = set_of(colours, variants);
    const double tiles = static_cast<double>(set.tiles.size());
    double sum = 0;
    constexpr int seeds = 10;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      const Tiling land = tile_land(set, 100, 100, seed);
      std::vector<double> counts(set.tiles.size());
      for (const std::uint16_t tile : land.tiles) counts[tile] += 1;
      const double expected = static_cast<double>(land.tiles.size()) / tiles;
      for (const double count : counts) sum += (count - expected) * (count - expected) / expected;
    }
    EXPECT_LT(sum / seeds / (tiles - 1), 2.0) << colours << " colours";
    EXPECT_GT(sum / seeds / (tiles - 1), 0.1) << "no chance in it";
  }
}

// No column or row repeats another: what one variant a pair would do.
TEST(TileLand, RowsAndColumnsDiffer) {
  const TileSet set = set_of(3, 2);
  const Tiling land = tile_land(set, 64, 64, 5);
  std::set<std::vector<std::uint16_t>> rows, columns;
  for (int i = 0; i < 64; ++i) {
    std::vector<std::uint16_t> row, column;
    for (int j = 0; j < 64; ++j) row.push_back(land.at(j, i)), column.push_back(land.at(i, j));
    rows.insert(row), columns.insert(column);
  }
  EXPECT_EQ(rows.size(), 64u);
  EXPECT_EQ(columns.size(), 64u);
}

TEST(TileLand, SameKeySameBytes) {
  const TileSet set = set_of(3, 2);
  EXPECT_EQ(tile_land(set, 40, 30, 7, 1), tile_land(set, 40, 30, 7, 1));
  EXPECT_NE(tile_land(set, 40, 30, 7, 1), tile_land(set, 40, 30, 8, 1));
  EXPECT_NE(tile_land(set, 40, 30, 7, 1), tile_land(set, 40, 30, 7, 2));
}

TEST(TileLand, LargerTilingsHoldTheSmaller) {
  const TileSet set = set_of(4, 3);
  const Tiling large = tile_land(set, 40, 30, 7), small = tile_land(set, 25, 12, 7);
  for (int row = 0; row < small.rows; ++row) {
    for (int column = 0; column < small.columns; ++column) ASSERT_EQ(small.at(column, row), large.at(column, row));
  }
}

TEST(TileLand, NothingToTileIsAnError) {
  const TileSet set = set_of(3, 2);
  EXPECT_THROW(tile_land(set, 0, 3, 1), base::Error);
  EXPECT_THROW(tile_land(set, 3, -1, 1), base::Error);
}

}  // namespace
}  // namespace silvasim::tiles
