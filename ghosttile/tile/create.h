// Makes a Ghost Tile: spreads candidates over it, and finds out which of them collide.
//
// Promise: the same tile for the same arguments on any number of threads. The graph equals the test of every pair with
//   every offset by the brute force (SphereColumns::collide).
// Errors: base::Error where the tile is so small beside its objects that their offsets would reach beyond `most_reach` tiles, or
//   where there are more candidates than the graph can name.
// Threads: parallel inside. Cost: about 0.2 to 1 microsecond a pair that collides.
// Source: Guérin et al. 2016, sections 4.2 and 4.3.
#pragma once

#include <vector>

#include "ghosttile/tile/frames.h"
#include "ghosttile/tile/ghost_tile.h"
#include "silvasim/base/progress.h"

namespace ghosttile::tile {

struct CreateOptions {
  float side_m = 0.5f;
  float delta_m = 0;
  std::uint64_t seed = 0;
  std::vector<Spread> spreads;  // one an object
};

inline constexpr int most_reach = 4;

// What making the graph took: pairs of candidates near enough to be looked at, and those that collide.
struct CreateCounts {
  std::uint64_t looked_at = 0, colliding = 0;
};

GhostTile create(std::vector<objects::Detail> objects, const CreateOptions& options,
                 const silvasim::base::Progress& progress = {}, CreateCounts* counts = nullptr);

}  // namespace ghosttile::tile
