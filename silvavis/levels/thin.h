// A simpler model that looks the same from far away: fewer leaves, each larger, and wood of fewer triangles.
//
// Leaves are the connected pieces whose material is cut out by a texture or lets light through. Every so-manieth is kept,
// chosen evenly over the crown, and all that stay are enlarged by two factors, across and upward, found so that the model
// covers the same area from the sides and from above as before. Wood is simplified by meshoptimizer.
// Promise: both areas are within 1 % of the model's, unless too few leaves are left for it; same model and share, same result.
// Threads: any. Cost: 0.15 s for 160,000 triangles.
// Source: Cook, Halstead, Planck and Ryu 2007 (Stochastic simplification of aggregate detail): area and colour are kept; here
//   the enlargement is measured instead of derived, because leaves hide each other.
#pragma once

#include <cstdint>

#include "assets/model.h"
#include "silvavis/base/vector.h"

namespace silvavis::levels {

struct Thinned {
  assets::Model model;
  float enlarged = 1;  // by how much the leaves' sides grew
};

// `share`: of the triangles that stay, in (0, 1).
Thinned thinned(const assets::Model& model, double share);

// The side of a typical leaf piece in metres (the median of the square roots of their areas); of the triangles where there are
// no leaves.
float leaf_size(const assets::Model& model);

}  // namespace silvavis::levels
