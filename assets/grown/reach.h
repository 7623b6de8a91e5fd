// Brings a plant to the radius and height that were asked for.
#pragma once

#include <vector>

#include "assets/vector.h"

namespace assets::grown {

// Stretches points so that the highest lies at the height and the farthest from the axis at the radius. In most
// directions the plant then reaches almost as far: single branches that stand out are drawn in. Points below the ground
// keep their depth. Nothing changes where all points lie on the axis.
void fit_points(std::vector<V3>& points, float height_m, float radius_m);

}  // namespace assets::grown
