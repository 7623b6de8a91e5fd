// Leaf-like strips: a ribbon along a curve.
#pragma once

#include <span>

#include "assets/grown/draws.h"
#include "assets/model.h"

namespace assets::grown {

// One cross section of a ribbon.
struct Rib {
  V3 middle, across, normal;  // unit across and normal
  float half_width = 0;       // 0 at the last rib: the ribbon ends in a point
  float v = 0;
};

struct Ribbon {
  int columns = 1;
  float fold = 0;  // the edges stand so far above the middle, as a share of the half width
  float u_low = 0, u_high = 1;
  std::uint16_t material = 0;
};

// Adds 2 * columns * (ribs - 1) triangles, `columns` fewer where the last rib is a point. Two ribs at least.
void add_ribbon(Model& model, std::span<const Rib> ribs, const Ribbon& ribbon);

}  // namespace assets::grown
