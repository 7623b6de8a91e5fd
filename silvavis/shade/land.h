// How the land looks: a picture draped over it, colours by class, or what grows and lies there; where water is; what is around it.
//
// The plain look is grass, by slope and height earth, scree and rock, under plants litter and moss; all in patches of several sizes,
// a function of the place. Reflectances and their sources: docs/light.md.
// Units: world space, metres. A drape's rows run from north to south; beyond it the plain look holds.
// Threads: asked from any.
#pragma once

#include <cstdint>
#include <vector>

#include "silvasim/base/geometry.h"
#include "silvavis/base/vector.h"
#include "silvavis/image/image.h"
#include "silvavis/shade/crowns.h"
#include "silvavis/shade/surroundings.h"

namespace silvavis::shade {

struct Land {
  image::Image drape;  // 3 channels, linear; empty: the plain look
  silvasim::base::Box drape_box;
  bool smooth = true;  // bilinear; false: the nearest pixel, for classes, which get the small patches of the ground

  std::vector<std::uint8_t> water;  // row by row from the north, 1 is water; empty: none
  int water_columns = 0, water_rows = 0;
  silvasim::base::Box water_box;

  Surroundings around;  // empty: nothing is around
};

// Linear reflectance of dry land at a point, where `up` is the land's normal; what stands over it, and how high it lies, changes
// the plain look. What is finer than a ray of `width_m` evens out.
Rgb land_colour(const Land& land, double x, double y, const V3& up, double height_m = 0, const Crowns& crowns = {},
                double width_m = 0);
bool is_water(const Land& land, double x, double y);

}  // namespace silvavis::shade
