// Points, directions and colours of models and pictures: Imath's vectors under short names.
//
// Units: metres. Frame: x to the east, y to the north, z up. Colours are linear, with the primaries of sRGB.
#pragma once

#include <Imath/ImathColor.h>
#include <Imath/ImathVec.h>

namespace assets {

using V2 = Imath::V2f;
using V3 = Imath::V3f;
using V3d = Imath::V3d;
using Rgb = Imath::C3f;

// The share that the eye sees as brightness (ITU-R BT.709).
inline float luminance(const Rgb& colour) { return 0.2126f * colour.x + 0.7152f * colour.y + 0.0722f * colour.z; }

}  // namespace assets
