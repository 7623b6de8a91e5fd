// Stems as solids, so that details keep out of them.
#pragma once

#include <vector>

#include "ghosttile/cover/fillers.h"
#include "ghosttile/density/node.h"

namespace ghosttile::cover {

struct TrunkOptions {
  float gap_m = 0;            // kept free around the stem
  float least_m = 0.02f;      // thinner stems are left out: twigs of shrubs
  float foot_m = 0.5f;        // how deep below the ground at the stem's axis it begins, for slopes
  float height_share = 0.5f;  // of the plant's height, up to where there is a stem to keep clear of
};

// The selected plants whose stems touch the box's rectangle, as upright cylinders without falloff: children for a `differ`. The radius
// is the one at breast height that Plants knows, without taper.
std::vector<density::Node> trunks(const Chosen& chosen, const density::Box3& box, const TrunkOptions& options = {});

}  // namespace ghosttile::cover
