// A detail: the small thing that Ghost Tiles repeat (the paper's object O), as triangles to see, spheres to collide with and
// points that ask the density fields.
//
// Units: metres, the object's own space: z is the axis that candidates are tilted by; the origin is what they turn about.
// Promise: what assets/model.h promises of the model; one sphere and one anchor at least, radii above 0, all finite.
// Source: Guérin et al. 2016, sections 4.1 and 4.3, figures 5 and 8.
#pragma once

#include <string>
#include <vector>

#include "assets/model.h"

namespace ghosttile::objects {

struct Sphere {
  assets::V3 centre{0, 0, 0};
  float radius_m = 0;

  friend bool operator==(const Sphere&, const Sphere&) = default;
};

// How far a sphere set is from the surface that it stands for.
struct SphereError {
  float outside_m = 0;    // the farthest that a sphere reaches out of the surface
  float uncovered_m = 0;  // the farthest that a point of the surface lies outside of all spheres
  float mean_m = 0;       // mean distance of the surface's points from the spheres' common surface
};

struct Detail {
  std::string name;
  assets::Model model;
  std::vector<Sphere> spheres;
  SphereError error;
  std::vector<assets::V3> anchors;
};

// The largest distance from the origin of anything of it.
float reach_of(const std::vector<Sphere>& spheres);

}  // namespace ghosttile::objects
