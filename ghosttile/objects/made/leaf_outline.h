// Outlines and veins of leaves, drawn in the plane: x across, y from the blade's foot at 0 to its tip at 1.
#pragma once

#include <string>
#include <vector>

#include "assets/vector.h"
#include "ghosttile/objects/made/parts.h"

namespace ghosttile::objects::made {

struct Vein {
  V2 from, to;
  float width = 0;  // at `from`; it tapers to half of that
};

struct LeafOutline {
  std::vector<V2> edge;  // a closed polygon
  std::vector<Vein> veins;
  float stalk = 0;  // share of the whole leaf's length that the stalk takes
};

LeafOutline leaf_outline(const std::string& form, Draws& draws);

}  // namespace ghosttile::objects::made
