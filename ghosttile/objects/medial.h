// Medial balls: the largest balls within a surface that touch it at given points.
//
// Source: Ma, Bae and Choi 2012 (3D medial axis point approximation using nearest neighbors and the normal field): a ball that
//   touches the surface at p shrinks until no other sample lies in it.
// Cost: samples squared, times about 6.
#pragma once

#include <vector>

#include "ghosttile/objects/surface.h"

namespace ghosttile::objects {

struct Ball {
  V3d centre{0, 0, 0};
  double radius_m = 0;
};

// One ball a sample, in order, with radii of at most `largest_m`. Normals point outward.
std::vector<Ball> medial_balls(const Samples& samples, double largest_m);

}  // namespace ghosttile::objects
