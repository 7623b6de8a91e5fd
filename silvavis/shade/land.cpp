#include "silvavis/shade/land.h"

#include <algorithm>
#include <cmath>

namespace silvavis::shade {

namespace {

float noise_at(std::int32_t i, std::int32_t j) {
  std::uint32_t h = static_cast<std::uint32_t>(i) * 0x9E3779B1u ^ static_cast<std::uint32_t>(j) * 0x85EBCA77u;
  h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
  h = (h ^ (h >> 12)) * 0x297A2D39u;
  return static_cast<float>((h ^ (h >> 15)) >> 8) * 0x1p-24f;
}

// Smooth noise in [0,1] with features of about `size_m` (value noise, three octaves).
float patches(double x, double y, double size_m) {
  float sum = 0, weight = 0.5f;
  for (int octave = 0; octave < 3; ++octave) {
    const double u = x / size_m, v = y / size_m;
    const double fu = std::floor(u), fv = std::floor(v);
    const auto i = static_cast<std::int32_t>(fu), j = static_cast<std::int32_t>(fv);
    auto s = static_cast<float>(u - fu), t = static_cast<float>(v - fv);
    s = s * s * (3 - 2 * s);
    t = t * t * (3 - 2 * t);
    const float south = noise_at(i, j) * (1 - s) + noise_at(i + 1, j) * s;
    const float north = noise_at(i, j + 1) * (1 - s) + noise_at(i + 1, j + 1) * s;
    sum += weight * (south * (1 - t) + north * t);
    weight *= 0.5f;
    size_m *= 0.37;
  }
  return sum / 0.875f;
}

Rgb mixed(const Rgb& a, const Rgb& b, float share) { return a * (1 - share) + b * share; }

// Grass where it is gentle, earth where it is steep, rock where it is steeper; none of it even.
Rgb plain_look(double x, double y, const V3& up) {
  const Rgb grass(0.058f, 0.082f, 0.030f), dry(0.130f, 0.118f, 0.060f), earth(0.115f, 0.085f, 0.058f),
      rock(0.19f, 0.18f, 0.165f);
  const float steepness = std::sqrt(std::max(0.0f, 1 - up.z * up.z)) / std::max(up.z, 0.05f);
  const float wide = patches(x, y, 160), fine = patches(x + 7919, y - 104729, 9);
  Rgb colour = mixed(grass, dry, std::clamp(1.9f * wide - 0.55f, 0.0f, 1.0f));
  colour = mixed(colour, earth, std::clamp(1.6f * steepness - 0.35f + 0.5f * (fine - 0.5f), 0.0f, 0.8f));
  colour = mixed(colour, rock, std::clamp((steepness - 0.75f) * 2.5f + 0.6f * (fine - 0.5f), 0.0f, 1.0f));
  return colour * (0.72f + 0.56f * fine);
}

}  // namespace

Rgb land_colour(const Land& land, double x, double y, const V3& up) {
  const silvasim::base::Box& box = land.drape_box;
  if (land.drape.empty() || !box.contains({x, y})) return plain_look(x, y, up);
  const double u = (x - box.west) / box.width() * land.drape.width,
               v = (box.north - y) / box.height() * land.drape.height;
  const auto pixel = [&](int i, int j) {
    const float* at = land.drape.at(std::clamp(i, 0, land.drape.width - 1), std::clamp(j, 0, land.drape.height - 1));
    return Rgb(at[0], at[1], at[2]);
  };
  if (!land.smooth) return pixel(static_cast<int>(u), static_cast<int>(v));
  const double left = std::floor(u - 0.5), top = std::floor(v - 0.5);
  const auto s = static_cast<float>(u - 0.5 - left), t = static_cast<float>(v - 0.5 - top);
  const int i = static_cast<int>(left), j = static_cast<int>(top);
  return mixed(mixed(pixel(i, j), pixel(i + 1, j), s), mixed(pixel(i, j + 1), pixel(i + 1, j + 1), s), t);
}

bool is_water(const Land& land, double x, double y) {
  if (land.water.empty() || !land.water_box.contains({x, y})) return false;
  const int i = std::min(static_cast<int>((x - land.water_box.west) / land.water_box.width() * land.water_columns),
                         land.water_columns - 1);
  const int j = std::min(static_cast<int>((land.water_box.north - y) / land.water_box.height() * land.water_rows),
                         land.water_rows - 1);
  return land.water[static_cast<std::size_t>(j) * static_cast<std::size_t>(land.water_columns) +
                    static_cast<std::size_t>(i)] != 0;
}

}  // namespace silvavis::shade
