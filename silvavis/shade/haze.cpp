#include "silvavis/shade/haze.h"

#include <algorithm>
#include <cmath>

#include "silvasim/base/math.h"

namespace silvavis::shade {

namespace {

namespace base = silvasim::base;

// One coefficient for a channel: the mean over its wavelengths, weighted with sunlight.
Rgb channel_means(const Spectrum& coefficient, const Spectrum& sun) {
  Spectrum weighted;
  for (std::size_t i = 0; i < wavelengths; ++i) weighted[i] = coefficient[i] * sun[i];
  return rgb_of(weighted) / rgb_of(sun);
}

}  // namespace

double haze_depth(double visibility_km, double from_height_m, double to_height_m, double distance_m) {
  constexpr double molecules_per_m = 1.16e-5;
  const double haze_per_m = std::max(0.0, 3.912 / (1000 * visibility_km) - molecules_per_m);  // Koschmieder
  const auto mean_density = [&](double scale_m) {
    const double from = from_height_m / scale_m, rise = (to_height_m - from_height_m) / scale_m;
    const double mean = std::abs(rise) < 1e-4 ? 1 - rise / 2 : (1 - base::exp(-rise)) / rise;
    return base::exp(-from) * mean;
  };
  return distance_m * (molecules_per_m * mean_density(Atmosphere::rayleigh_height_m) +
                       haze_per_m * mean_density(Atmosphere::mie_height_m));
}

Haze::Haze(const Sky& sky, const HazeOptions& options) : sun_(sky.sun_direction()), options_(options) {
  const Atmosphere& air = sky.air();
  rayleigh_ = channel_means(air.rayleigh(), air.sun());
  mie_ = channel_means(air.mie(), air.sun());
  const float level = std::sqrt(sun_.x * sun_.x + sun_.y * sun_.y);
  level_x_ = level > 1e-6f ? sun_.x / level : 1;
  level_y_ = level > 1e-6f ? sun_.y / level : 0;
  for (std::size_t level_row = 0; level_row < Sky::air_levels; ++level_row) {
    for (std::size_t i = 0; i < around_; ++i) {
      const SkyNode& node = sky.air_light()[level_row][i];
      light_[level_row][i] = {node.rayleigh.x, node.rayleigh.y, node.rayleigh.z, 0,
                              node.mie.x,      node.mie.y,      node.mie.z,      0,
                              node.multiple.x, node.multiple.y, node.multiple.z, 0};
    }
  }
}

Haze::Veil Haze::veil(float distance_m, float eye_height_m, const V3& d) const {
  constexpr float least_height_m = -1000, most_height_m = 60e3f, most_distance_m = 1e6f;
  constexpr float per_rayleigh = static_cast<float>(1 / Atmosphere::rayleigh_height_m);
  constexpr float per_mie = static_cast<float>(1 / Atmosphere::mie_height_m);
  // A ray that goes on beneath the ground must not meet ever denser air. Above 60 km there is none.
  const float distance = std::clamp(distance_m, 0.0f, most_distance_m),
              eye = std::clamp(eye_height_m, least_height_m, most_height_m);
  const float rise = std::max(distance * d.z, least_height_m - eye);
  // Four at a time, and without branches: the compiler makes one of them.
  const std::array<float, 4> rises = {rise * per_rayleigh, rise * per_mie, eye * per_rayleigh, eye * per_mie};
  std::array<float, 4> density, mean;
  for (std::size_t n = 0; n < 4; ++n) density[n] = base::exp(-rises[n]);
  // The mean of exp(-height / scale) along a ray that rises by that many scales, for level rays by its series.
  for (std::size_t n = 0; n < 4; ++n) {
    const float r = rises[n], series = 1 - r * (0.5f - r * (1.0f / 6));
    const bool level_ray = r * r < 1e-4f;
    mean[n] = base::select(level_ray, series, (1 - density[n]) / base::select(level_ray, 1.0f, r));
  }
  float molecules = distance * density[2] * mean[0], droplets = distance * density[3] * mean[1];
  if (options_.share < 1) {
    const float t = std::clamp(0.5f * (distance / std::max(options_.clear_m, 1e-3f) - 1), 0.0f, 1.0f);
    const float share = options_.share + (1 - options_.share) * t * t * (3 - 2 * t);
    molecules *= share;
    droplets *= share;
  }

  // The mean height of the air on the way: of both ends, each by its density in green light.
  const float at_eye = rayleigh_.y * density[2] + mie_.y * density[3];
  const float at_end = rayleigh_.y * density[2] * density[0] + mie_.y * density[3] * density[1];
  const float height = eye + rise * (at_end / (at_eye + at_end + 1e-30f));
  const float level = std::sqrt(d.x * d.x + d.y * d.y);
  const float around = level > 1e-6f ? (d.x * level_x_ + d.y * level_y_) / level : 1;
  const float x = std::sqrt(std::clamp((1 - around) * 0.5f, 0.0f, 1.0f)) * (around_ - 1);
  const float y = std::sqrt(std::clamp(height * (1 / Sky::air_top_m), 0.0f, 1.0f)) * (Sky::air_levels - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(x), around_ - 2);
  const std::size_t k = std::min(static_cast<std::size_t>(y), Sky::air_levels - 2);
  const float tx = x - static_cast<float>(i), ty = y - static_cast<float>(k);
  const std::array<float, 4> weights = {(1 - tx) * (1 - ty), tx * (1 - ty), (1 - tx) * ty, tx * ty};
  const Node &a = light_[k][i], &b = light_[k][i + 1], &c = light_[k + 1][i], &e = light_[k + 1][i + 1];
  Node light;
  for (std::size_t n = 0; n < light.size(); ++n) {
    light[n] = weights[0] * a[n] + weights[1] * b[n] + weights[2] * c[n] + weights[3] * e[n];
  }

  const float cosine = d.dot(sun_), phase_rayleigh = rayleigh_phase(cosine), phase_mie = mie_phase(cosine);
  const std::array<float, 4> extinct_rayleigh = {rayleigh_.x, rayleigh_.y, rayleigh_.z, 0};
  const std::array<float, 4> extinct_mie = {mie_.x, mie_.y, mie_.z, 0};
  std::array<float, 4> left, added;
  for (std::size_t n = 0; n < 4; ++n) {
    const float depth_rayleigh = extinct_rayleigh[n] * molecules, depth_mie = extinct_mie[n] * droplets;
    const float depth = depth_rayleigh + depth_mie;
    left[n] = base::exp(-depth);
    // 1 - exp(-x) loses its digits near 0.
    const float taken = base::select(depth < 1e-3f, depth * (1 - 0.5f * depth), 1 - left[n]);
    const float once =
        (light[n] * phase_rayleigh * depth_rayleigh + light[n + 4] * phase_mie * depth_mie) / (depth + 1e-30f);
    added[n] = taken * std::max(0.0f, once + light[n + 8]);
  }
  return {Rgb(left[0], left[1], left[2]), Rgb(added[0], added[1], added[2])};
}

Rgb Haze::apply(const Rgb& colour, float distance_m, float eye_height_m, const V3& direction) const {
  const Veil v = veil(distance_m, eye_height_m, direction);
  return colour * v.transmittance + v.in_scattered;
}

}  // namespace silvavis::shade
