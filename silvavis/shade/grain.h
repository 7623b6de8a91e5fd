// What the ground consists of, seen from near: blades of grass, leaves of litter, stones. As factors of its colour, 1 on the mean.
//
// Functions of the place alone. What a ray of `width_m` is too wide for evens out, and then costs nothing.
// Threads: any. Cost: 0.1 to 0.4 µs within some 20 m of the eye of a picture 1000 pixels wide, nothing far away.
#pragma once

#include "silvavis/base/vector.h"

namespace silvavis::shade {

// Shares of the ground; they add up to 1.
struct GroundParts {
  float grass = 1, litter = 0, earth = 0, scree = 0, rock = 0;
};
Rgb grain(const GroundParts& parts, double x, double y, double width_m);

// Cells of all shapes about `size_m` wide, as leaves, stones and blocks lie beside each other (Worley 1996).
struct Flake {
  float tone = 0.5f;  // of the cell, in [0, 1], mean 0.5
  float inside = 1;   // 0 at its edge, 1 from a third of the way to its middle on
};
Flake flake(double x, double y, double size_m);

}  // namespace silvavis::shade
