// What the air does to the picture of a distant thing: it takes light away, and adds its own.
//
// The air gets thinner with height as in sky.h (exp(-height / 8400 m) for its molecules, exp(-height / 1200 m) for haze);
// along a straight ray that has a closed form. The light that it adds is that of level rays at the mean height of the air that the ray meets, as
// it would be at the ray's angle to the sun. On the ground that is the sky's horizon: so what is far enough away fades
// into the horizon.
//
// Heights above the land around (SkyOptions), directions unit vectors from the eye.
// Promise: finite, never negative; distance 0 changes nothing. Against the integral over a round, spectral atmosphere
//   within 10 % for rays up to 40 km that look level or down (docs/light.md).
// Threads: any. Cost: 85 ns on a busy 2 GHz core. Holds no reference to the sky.
#pragma once

#include <array>

#include "silvavis/shade/sky.h"

namespace silvavis::shade {

struct HazeOptions {
  // A share of the air, for what is no farther than a distance: how pictures of wide land are freed of haze to show the land. At
  // three times that distance the air is as thick as it is. 1: nowhere.
  float share = 1;
  float clear_m = 0;
};

// Depth of the air in green light (550 nm) between two heights above the ground that are `distance_m` apart.
double haze_depth(double visibility_km, double from_height_m, double to_height_m, double distance_m);

class Haze {
 public:
  explicit Haze(const Sky& sky, const HazeOptions& options = {});

  // What is left of the colour of a thing at that distance, and the air's light before it.
  Rgb apply(const Rgb& colour, float distance_m, float eye_height_m, const V3& direction) const;

  // The two by themselves: apply() is colour * transmittance + in_scattered.
  struct Veil {
    Rgb transmittance, in_scattered;
  };
  Veil veil(float distance_m, float eye_height_m, const V3& direction) const;

 private:
  static constexpr std::size_t around_ = Sky::around;
  // Red, green, blue and nothing, of molecules, of haze, and of what was scattered more than once.
  using Node = std::array<float, 12>;

  Rgb rayleigh_, mie_;  // extinction per metre at the ground
  V3 sun_;
  HazeOptions options_;
  float level_x_ = 0, level_y_ = 0;
  std::array<std::array<Node, around_>, Sky::air_levels> light_;
};

}  // namespace silvavis::shade
