// Cubic B-splines: smooth everywhere, a little softer than what they spread.
#pragma once

#include <array>

namespace silvasim::exports {

// Weights of the cells before, at, after and two after, for a point at `t` in [0, 1) between the middle two. Their sum is 1.
inline std::array<float, 4> cubic_spline(float t) {
  const float s = 1 - t;
  return {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * s * s * s - 6 * s * s + 4) / 6, t * t * t / 6};
}

}  // namespace silvasim::exports
