// Direction fields: which way details shall point at a place, and how well a candidate must keep to it.
//
// Source: Guérin et al. 2016, section 5.3, "Control", figure 17.
#pragma once

#include <vector>

#include "ghosttile/density/field.h"

namespace ghosttile::density {

enum class DirectionKind {
  vertical,    // straight up
  constant,    // `vector`
  gradient,    // along the density's own gradient, outward: from dense to thin
  rotational,  // around the upright axis through `centre`, anticlockwise seen from above
  radial,      // away from the upright axis through `centre`
  normal,      // the ground's normal
};

struct Direction {
  DirectionKind kind = DirectionKind::vertical;
  V3d vector{0, 0, 1};
  V3d centre{0, 0, 0};
  const Plane* ground = nullptr;  // for normal; heights
  float least_cosine = -1;        // a candidate whose z-axis has less of it is left out
  float most_cosine = 1;
};

// How far about a point the density is asked for its gradient: cut the field down to a box that is so much larger.
inline constexpr float gradient_step_m = 0.01f;

// direction[i] of unit length at points[i], or 0 where there is none (on the axis, where the gradient vanishes).
// `density`: the compiled density, for gradient; six evaluations.
void directions_at(const Direction& direction, const V3d& corner, const Points& points, const Compiled& density,
                   Scratch& scratch, V3* result);

}  // namespace ghosttile::density
