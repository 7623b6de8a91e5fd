// Which materials are leaves, and how much light passes them.
//
// No format says it, so it is guessed: a material whose name speaks of leaves, needles, grass, flowers and the like; or one
// with cut-out texture whose name does not speak of wood, bark or stone; or a two-sided one of plainly green colour.
#pragma once

#include <string>

#include "assets/vector.h"

namespace assets {

enum class Foliage { none, leaf, needle };

struct LeafSigns {
  std::string names;       // of the material and its picture
  bool cut_out = false;    // its texture has holes
  bool two_sided = false;  // the file says so
  Rgb colour;              // mean, with the texture
};

Foliage foliage(const LeafSigns& signs);

struct LeafColour {
  Rgb reflectance;
  Rgb transmittance;
};

// The light that a leaf of this colour reflects and lets through, as Material has them. Broad leaves let through somewhat
// less than they reflect, and relatively more of it in the green: here 0.6, 0.9 and 0.4 of the reflectance in red, green and
// blue, round figures of the kind that PROSPECT gives (Jacquemoud and Baret 1990); a needle is thicker and lets through
// half of that. Both are lowered where a texel half as bright again as `texture_mean` (white without a texture) would
// give back more than 0.95 of the light. Foliage::none: the colour as it is, and nothing passes.
LeafColour leaf_colour(Foliage foliage, const Rgb& colour, const Rgb& texture_mean);

}  // namespace assets
