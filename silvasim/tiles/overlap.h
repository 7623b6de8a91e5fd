// When the free discs of two sites overlap: the one rule that filling, pruning and their tests share.
//
// Promise: the same answer whichever site comes first, on any machine; discs that only touch do not overlap.
#pragma once

#include "silvasim/tiles/tile_set.h"

namespace silvasim::tiles {

// (`dx_m`, `dy_m`): from the origin of a's tile to the origin of b's tile, zero within one tile. In double on the
// stored floats; the difference of the positions is taken first, so that swapping the sites only changes its sign.
inline bool overlap(const Site& a, const Site& b, double dx_m = 0, double dy_m = 0) {
  const double x = (static_cast<double>(b.x_m) - static_cast<double>(a.x_m)) + dx_m;
  const double y = (static_cast<double>(b.y_m) - static_cast<double>(a.y_m)) + dy_m;
  const double reach = static_cast<double>(a.radius_m) + static_cast<double>(b.radius_m);
  return x * x + y * y < reach * reach;
}

}  // namespace silvasim::tiles
