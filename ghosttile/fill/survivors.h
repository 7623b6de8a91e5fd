// Tiling and culling: which candidates of which tiles may stand, and when their turn comes.
//
// A candidate survives where the density of its object is above 0 at all its anchors, and its direction and scale suit the
// place. Its turn is a pure function of the place: a stage, then its tile's colour in that stage, then chance within the tile. In a
// stage a tile may place about one instance, and colours come in another order in each: that is the paper's round, with the order known
// beforehand, so that what stands at a place is settled by what is near (select.h).
//   random: the turn is drawn with the density as rate (an exponential race), four stages to a doubling of rank. Among the remaining
//     candidates of a tile, objects come up by their mean density.
//   elevation, boundary: by levels first (an eighth of a tile of height above the ground; a sixteenth of density), chance within,
//     a stage to a doubling of rank.
// Memory: 3 to 4 bytes a survivor.
// Source: Guérin et al. 2016, sections 5.1 to 5.3; docs/ghost-tiles.md, E5 and E6.
#pragma once

#include <cstdint>
#include <vector>

#include "ghosttile/fill/plan.h"
#include "ghosttile/fill/tile_index.h"
#include "silvasim/base/progress.h"

namespace ghosttile::fill {

// So many tiles share a compiled field; aligned to the scene's zero, so that values never depend on what is filled.
inline constexpr int block_tiles = 4;  // along x and y; 1 along z

struct Block {
  int x = 0, y = 0, z = 0;                 // tile of its south-western corner
  std::vector<density::Compiled> density;  // by object; kept where an instance may be refused
};

struct Run {
  std::uint16_t stage = 0, count = 0;
};

struct Survivors {
  TileIndex index;
  std::uint32_t words = 0;  // of 64 candidates, a tile
  // By slot: the bits of `words` words, the runs [first_run, ...), the candidates [first, ...) in the order of their stages.
  std::vector<std::uint64_t> alive;
  std::vector<std::uint32_t> first_run, first;
  std::vector<Run> runs;
  std::vector<std::uint16_t> order;
  std::vector<Block> blocks;     // of tiles where a candidate may be refused
  std::int32_t first_stage = 0;  // what the runs' stages are counted from
  std::uint32_t stages = 0;
  std::uint64_t looked_at = 0;  // candidates of the tiles that were not culled as a whole
};

// Of the tiles within the box.
Survivors survivors_of(const Plan& plan, const TileBox& box, const silvasim::base::Progress& progress = {});

}  // namespace ghosttile::fill
