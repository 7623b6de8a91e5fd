// Points, directions and colours of the renderer: those of the models.
//
// World space is the scene's frame moved so that the scene's `origin` lies at (0, 0, 0): floats keep 2 mm at 20 km.
#pragma once

#include "assets/vector.h"

namespace silvavis {

using assets::Rgb;
using assets::V2;
using assets::V3;
using assets::V3d;

using assets::luminance;

}  // namespace silvavis
