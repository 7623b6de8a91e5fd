// A size field: how large or small details may be at a place, by a density field that leads from one limit to the other.
//
// Source: Guérin et al. 2016, abstract and section 3: control fields "specify the size or the orientation".
#pragma once

#include "ghosttile/density/field.h"

namespace ghosttile::density {

// Limits of a candidate's scale where the field is 0 and where it is 1, straight between; beyond 1 as at 1.
struct SizeField {
  Field field;
  Range where_none{0, 1e9f};
  Range where_full{0, 1e9f};
};

// least[i] and most[i] of the scale at points[i]; `field`: size.field compiled near the points.
void scale_limits(const SizeField& size, const Compiled& field, const Points& points, Scratch& scratch, float* least,
                  float* most);

}  // namespace ghosttile::density
