// Lays tiles over the land so that the colours of touching edges agree.
//
// Each tile is drawn from those that fit its northern and western neighbour, keyed by (seed, layer, column, row).
// Promise: same arguments, same bytes; a larger tiling holds the smaller ones in its north-west corner; every tile is equally
//   likely at every position.
// Errors: base::Error without a column or a row.
// Source: Silva 2013, section 4 (step 2, "tiling of the terrain"); Cohen et al. 2003.
#pragma once

#include <cstdint>

#include "silvasim/tiles/tile_set.h"

namespace silvasim::tiles {

Tiling tile_land(const TileSet& set, int columns, int rows, std::uint64_t seed, std::uint32_t layer = 0);

}  // namespace silvasim::tiles
