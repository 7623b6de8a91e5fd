// The tree over one Wang tile's sites.
//
// A kd-tree cut at medians along the longer side, whose four levels at a time are one node of sixteen children; cuts fall on
// multiples of eight sites, so that all leaves but the last are full. A usual tile (about 130 sites) is one node above sixteen leaves.
// Source: Silva 2013, section 5, figure 6 (cuts in x and y only).
#pragma once

#include "silvasim/tiles/tile_set.h"
#include "silvavis/scene/scene.h"

namespace silvavis::scene {

// `most_reach`: greatest horizontal reach of any plant over its site's radius.
TileSites make_tile_sites(const silvasim::tiles::Tile& tile, float most_reach);

}  // namespace silvavis::scene
