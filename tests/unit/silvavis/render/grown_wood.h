// What the tests of pictures look at.
#pragma once

#include "silvavis/render.h"

namespace silvavis::testing {

// A wood of grown trees of two species, with their levels.
scene::Scene grown_wood(int columns, int triangles);

// 160 x 90 pixels of 4 samples, downwards from the south.
RenderOptions small_picture(const scene::Scene& scene, double away_m);

}  // namespace silvavis::testing
