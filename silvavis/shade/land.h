// How the land looks: a picture draped over it, colours by class, or earth and grass by slope; and where water is.
//
// Units: world space, metres. A drape's rows run from north to south; beyond it the plain look holds.
// Threads: asked from any.
#pragma once

#include <cstdint>
#include <vector>

#include "silvasim/base/geometry.h"
#include "silvavis/base/vector.h"
#include "silvavis/image/image.h"

namespace silvavis::shade {

struct Land {
  image::Image drape;  // 3 channels, linear; empty: the plain look
  silvasim::base::Box drape_box;
  bool smooth = true;  // bilinear; false: the nearest pixel, for classes

  std::vector<std::uint8_t> water;  // row by row from the north, 1 is water; empty: none
  int water_columns = 0, water_rows = 0;
  silvasim::base::Box water_box;
};

// Linear reflectance of dry land at a point, where `up` is the land's normal.
Rgb land_colour(const Land& land, double x, double y, const V3& up);
bool is_water(const Land& land, double x, double y);

}  // namespace silvavis::shade
