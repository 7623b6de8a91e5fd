// Directions towards the light of the sky, more of them where it is bright: around a low sun, and along the horizon at dusk.
//
// A surface that asks the sky in directions by the cosine alone meets the bright part so seldom that each meeting is a spark in the
// picture. So a share of the directions is drawn by the sky's own light above its mean, and all count by the density of both
// together: nothing becomes lighter or darker as a whole.
// Units: unit directions in the scene's frame, densities per steradian, u and v in [0, 1).
// Threads: asked from any. Cost: made in 1 ms; 60 ns a direction. Source: Veach and Guibas 1995 (the balance heuristic, one sample
//   of both); Karlík et al. 2019 (the light's density less what the other way finds by itself).
#pragma once

#include <array>

#include "silvavis/shade/sky.h"

namespace silvavis::shade {

class SkyRays {
 public:
  explicit SkyRays(const Sky& sky);

  // Of the directions that a surface asks; 0 for an even sky.
  float share() const { return share_; }

  // Drawn by the light.
  V3 towards(float u, float v) const;
  // With which density towards() gives it.
  float density(const V3& direction) const;

 private:
  // Rows over the sine of elevation, dense at the horizon; columns over half of the turn away from the sun, by the sine of half the
  // angle, dense at the sun.
  static constexpr std::size_t rows_ = 48, columns_ = 32;

  float share_ = 0;
  float level_x_ = 1, level_y_ = 0;  // the sun's azimuth
  std::array<float, rows_ + 1> edges_{};
  std::array<float, rows_ + 1> row_sums_{};                           // from 0 to 1
  std::array<std::array<float, columns_ + 1>, rows_> column_sums_{};  // likewise in each row
  std::array<std::array<float, columns_>, rows_> densities_{};        // over sine and column coordinate
};

}  // namespace silvavis::shade
