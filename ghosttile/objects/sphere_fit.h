// Sphere sets: what Ghost Tiles collide instead of triangles.
//
// Parts with a volume get medial spheres: inside balls that touch the surface, chosen greedily so that the surface comes to lie
// near them, then moved among their like until that no longer helps. Parts without (leaf cards, blades, surfaces with a hole,
// sheets 25 times as wide as thick) are shells: spheres of one radius evenly on the surface, which hold every point of it.
//
// Promise: one sphere at least, `spheres` at most. A sphere of a solid part reaches out of the surface by at most
//   `outside_share` of its radius, measured against the triangles themselves. Same bytes for the same arguments anywhere;
//   turning and scaling the model turns and scales the spheres, but for rounding.
// Errors: base::Error naming the model: what surface.h refuses, options out of range, a shell too large for its thickness.
// Threads: any number at once. Cost: 0.1 s for a stone of 320 triangles, 0.25 s for 20,000, 2.8 s for 330,000; 1024
// spheres in a box 4.7 s.
// Source: Ma, Bae and Choi 2012 (balls); Stolpner, Kry and Siddiqi 2012 (choice of medial spheres); Guérin et al. 2016, 4.3.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ghosttile/objects/detail.h"

namespace ghosttile::objects {

inline constexpr int most_spheres = 1024;
inline constexpr float most_outside = 10;

struct SphereFitOptions {
  int spheres = 24;  // 1 to most_spheres; fewer where fewer are as good
  std::uint64_t seed = 0;
  float outside_share =
      0.1f;  // 0 to most_outside; thin bars need more, or more spheres, to close the gaps between the spheres
  float thickness_m = 0;   // half thickness of shells, their spheres' radius; 0: as `spheres` need to hold all of it
  bool all_shell = false;  // take solid parts for shells too
};

struct SphereFit {
  std::vector<Sphere> spheres;
  SphereError error;
};

SphereFit fit_spheres(const assets::Model& model, const SphereFitOptions& options = {});

// How far any sphere set is from the model: 16,384 points of the surface; the spheres' reach outside by the distance of
// their centres from the triangles, which is never too small.
SphereError error_of(const assets::Model& model, const std::vector<Sphere>& spheres, std::uint64_t seed = 0);

}  // namespace ghosttile::objects
