// Fills land with details.
//
// Promise: the same details for the same plan and place on any number of threads and whatever the box; no two collide by the
//   graph; nothing that could be placed is left. A tile belongs to the result with all its instances or none.
// Errors: base::Error where a field is unbounded and the box too, or more than `most_tiles` tiles would have to be worked on.
// Threads: parallel inside.
// Cost: about 20 ns a candidate of tiles that are not culled as a whole.
// Source: Guérin et al. 2016, section 5.
#pragma once

#include "ghosttile/fill/details.h"
#include "ghosttile/fill/plan.h"
#include "silvasim/base/progress.h"

namespace ghosttile::fill {

struct FillCounts {
  std::uint64_t candidates = 0;  // of all tiles of the box, those culled as a whole too
  std::uint64_t looked_at = 0;   // of tiles that were not
  std::uint64_t possible = 0;    // that survived culling
  int margin = 0;                // tiles around the box that had to be worked on
};

inline constexpr std::uint64_t most_tiles = 200'000'000;

// `box` beyond tiles_of(plan) costs nothing.
Details fill(const Plan& plan, const TileBox& box, const silvasim::base::Progress& progress = {},
             FillCounts* counts = nullptr);

// Fills the tiles of `box` anew after the plan has changed there, and keeps all others as they are: what is placed collides
// with nothing in them.
Details refill(const Plan& plan, const Details& before, const TileBox& box,
               const silvasim::base::Progress& progress = {});

}  // namespace ghosttile::fill
