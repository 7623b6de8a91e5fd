// The place of a point along a Hilbert curve through a cube: what is near along it is near in space.
//
// Source: Skilling 2004 (Programming the Hilbert curve), by Gray codes.
#pragma once

#include <cstdint>

#include "assets/vector.h"

namespace ghosttile::tile {

// `share`: in [0, 1)^3; 10 bits an axis.
std::uint32_t hilbert_place(const assets::V3& share);

}  // namespace ghosttile::tile
