// How much of a picture a model covers, seen from far away in a direction: what a simpler model must keep.
#pragma once

#include <cstdint>
#include <vector>

#include "assets/model.h"
#include "silvavis/base/vector.h"

namespace silvavis::levels {

// Square metres that are covered in an orthographic view along `direction` (unit), holes cut out, on cells of `cell_m`:
// a cell counts where its centre is covered. Threads: any.
double covered_area(const assets::Model& model, const V3& direction, float cell_m);

}  // namespace silvavis::levels
