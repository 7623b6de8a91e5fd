#include "silvavis/shade/patches.h"

#include <algorithm>
#include <cmath>

namespace silvavis::shade {

namespace {

float noise_at(std::int32_t i, std::int32_t j) { return static_cast<float>(place_hash(i, j) >> 8) * 0x1p-24f; }

}  // namespace

std::uint32_t place_hash(std::int32_t i, std::int32_t j) {
  std::uint32_t h = static_cast<std::uint32_t>(i) * 0x9E3779B1u ^ static_cast<std::uint32_t>(j) * 0x85EBCA77u;
  h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
  h = (h ^ (h >> 12)) * 0x297A2D39u;
  return h ^ (h >> 15);
}

float lumps(double x, double y, double size_m, double width_m) {
  const auto shown = static_cast<float>(std::clamp(1.8 - width_m / size_m, 0.0, 1.0));
  if (shown <= 0) return 0.5f;
  const double u = x / size_m, v = y / size_m;
  const double fu = std::floor(u), fv = std::floor(v);
  const auto i = static_cast<std::int32_t>(fu), j = static_cast<std::int32_t>(fv);
  auto s = static_cast<float>(u - fu), t = static_cast<float>(v - fv);
  s = s * s * (3 - 2 * s);
  t = t * t * (3 - 2 * t);
  const float south = noise_at(i, j) * (1 - s) + noise_at(i + 1, j) * s;
  const float north = noise_at(i, j + 1) * (1 - s) + noise_at(i + 1, j + 1) * s;
  return 0.5f + shown * (south * (1 - t) + north * t - 0.5f);
}

float patches(double x, double y, double size_m, double width_m) {
  float sum = 0, weight = 0.5f;
  for (int octave = 0; octave < 3; ++octave) {
    sum += weight * lumps(x, y, size_m, width_m);
    weight *= 0.5f;
    size_m *= 0.37;
  }
  return sum / 0.875f;
}

}  // namespace silvavis::shade
