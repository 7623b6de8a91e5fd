// What stands over a place on the ground: found in the tiles' own trees, nothing is stored for it.
// Threads: any. Cost: 0.1 to 0.3 µs in a wood.
#pragma once

#include "silvavis/scene/scene.h"

namespace silvavis::shade {

struct Crowns {
  float cover = 0;  // 1 well under a crown, falling to 0 a quarter of its radius beyond its edge
  float foot = 0;   // 1 at a stem, 0 from a fifth of the crown's radius on
  float near = 0;   // 1 at a crown, 0 from `gap_m` beside it: what lies between the trees of a wood
  static constexpr float gap_m = 5;
};
Crowns crowns_over(const scene::Scene& scene, double x, double y);

}  // namespace silvavis::shade
