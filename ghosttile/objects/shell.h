// Spheres on surfaces without a volume: leaves, blades, needles drawn as cards.
//
// Promise: every point of the shell lies in a sphere, by proof and not by sampling: triangles are halved until a sphere holds each.
// Source: farthest points (Gonzalez 1985), then each sphere moves to where its own points need the least radius.
#pragma once

#include <vector>

#include "ghosttile/objects/medial.h"

namespace ghosttile::objects {

// `count` spheres of one radius, no larger than needed. With `radius_m` above 0: spheres of this radius instead, as many as
// the surface takes, `most` at most; returns none if that is not enough.
std::vector<Ball> cover_shell(const Surface& surface, const Samples& samples, std::size_t count, double radius_m,
                              std::size_t most);

// The farthest that a point of the shell lies from the nearest centre, at most 1 % too much, and where that is.
struct Cover {
  double radius_m = 0;
  V3d farthest{0, 0, 0};
};
Cover cover_of(const Surface& surface, const std::vector<V3d>& centres);

}  // namespace ghosttile::objects
