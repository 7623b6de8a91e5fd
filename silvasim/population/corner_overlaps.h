// Which sites of a tile set overlap where tiles meet at a vertex of the tiling. Plants play no part yet, so it is found
// once for all vertices at which the same tiles meet.
//
// Promise: only sites within 4 Rmax of the vertex (along x and along y) are looked at.
// Cost: a table entry for each two tiles that meet, up to 256 tiles; larger sets are searched at each vertex.
// Threads: between() may be called from several, each with a `scratch` of its own.
// Source: Silva 2013, section 4.4; docs/reading.md, A3.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "silvasim/tiles/tile_set.h"

namespace silvasim::population {

// The four tiles around a vertex, in the order of their positions in the tiling: the north-western one touches the
// vertex with its south-eastern corner, and so on.
enum Quarter : std::size_t { north_west, north_east, south_west, south_east, quarter_count };

struct QuarterTile {
  std::size_t quarter;
  std::size_t tile;  // index into TileSet::tiles
};

struct SitePair {
  std::uint32_t a, b;  // site ids
};

class CornerOverlaps {
 public:
  // `set` must outlive it.
  CornerOverlaps(const tiles::TileSet& set, const tiles::Tiling& tiling);

  // Overlapping pairs (site of a, site of b), ordered by a, then b; within one tile each pair once, a < b. Needs
  // a.quarter <= b.quarter, and tiles that meet so in the tiling. The answer may lie in `scratch`.
  std::span<const SitePair> between(QuarterTile a, QuarterTile b, std::vector<SitePair>& scratch) const;

 private:
  std::vector<std::uint32_t> sites_near(std::size_t quarter, const tiles::Tile& tile) const;
  void find(QuarterTile a, QuarterTile b, std::vector<SitePair>& pairs) const;
  void make_table(const tiles::Tiling& tiling);
  std::size_t slot(QuarterTile a, QuarterTile b) const {
    return ((a.quarter * quarter_count + b.quarter) * tile_count_ + a.tile) * tile_count_ + b.tile;
  }

  const tiles::TileSet& set_;
  std::size_t tile_count_;
  std::vector<std::vector<std::uint32_t>> near_;  // by quarter, then tile: the sites near the vertex, by id
  std::vector<std::vector<SitePair>> table_;      // by slot(); empty: no table
};

}  // namespace silvasim::population
