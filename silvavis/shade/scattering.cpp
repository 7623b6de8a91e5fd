#include "silvavis/shade/scattering.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "silvasim/base/math.h"

namespace silvavis::shade {

namespace {

namespace base = silvasim::base;

constexpr double earth_m = Atmosphere::ground_radius_m;

// A point on a ray, and how high the sun stands there.
struct Stop {
  float height_m, sun_sine;
};

Stop stop_at(const SkyRay& ray, double sun_sine, double along_m) {
  const double r = earth_m + ray.height_m;
  const double radius = std::sqrt(r * r + along_m * along_m + 2 * r * along_m * ray.sine);
  return {static_cast<float>(radius - earth_m),
          static_cast<float>(std::clamp((r * sun_sine + along_m * ray.sun_cosine) / radius, -1.0, 1.0))};
}

// The air in a step, wavelength by wavelength.
struct Step {
  Spectrum scattered_rayleigh, scattered_mie, mie, extinction;
};

Step step_of(const Atmosphere& air, float height_m) {
  const Columns density = Atmosphere::densities(height_m);
  Step step;
  for (std::size_t i = 0; i < wavelengths; ++i) {
    step.scattered_rayleigh[i] = air.rayleigh()[i] * density.rayleigh;
    const float high = air.aloft()[i] * density.aloft;
    step.scattered_mie[i] = air.mie_scattered()[i] * density.mie + high;
    step.mie[i] = air.mie()[i] * density.mie + high;
    step.extinction[i] = step.scattered_rayleigh[i] + step.mie[i] + air.ozone()[i] * density.ozone;
  }
  return step;
}

Spectrum sunlight_at(const Atmosphere& air, const Stop& stop) {
  const float share = Atmosphere::share_of_sun(stop.height_m, stop.sun_sine);
  if (share <= 0) return filled(0);
  Spectrum light = air.transmittance(air.to_top(stop.height_m, stop.sun_sine));
  for (float& value : light) value *= share;
  return light;
}

// Directions over the sphere, each for the same share of it: 8 heights by Gauss would do no better with so few steps.
struct Sphere {
  static constexpr std::size_t rows = 8, columns = 8;
  std::array<V3d, rows * columns> directions;

  Sphere() {
    // Turns of 45 degrees, and half of one, so that the sun's azimuth is not among them.
    constexpr double c = 0.9238795325112867, s = 0.3826834323650898;
    constexpr std::array<std::array<double, 2>, columns> around = {
        {{c, s}, {s, c}, {-s, c}, {-c, s}, {-c, -s}, {-s, -c}, {s, -c}, {c, -s}}};
    for (std::size_t row = 0; row < rows; ++row) {
      const double z = (2.0 * static_cast<double>(row) + 1) / rows - 1, level = std::sqrt(1 - z * z);
      for (std::size_t i = 0; i < columns; ++i) {
        directions[row * columns + i] = V3d(around[i][0] * level, around[i][1] * level, z);
      }
    }
  }
};

// Section 5.5 of Hillaire 2020 for one point: twice scattered light, over 1 less the share that is scattered on.
Spectrum multiple_at(const Atmosphere& air, double height_m, double sun_sine, const Spectrum& albedo) {
  static const Sphere sphere;
  constexpr int steps = 12;
  Spectrum second = filled(0), passed_on = filled(0);
  const double sun_level = std::sqrt(std::max(0.0, 1 - sun_sine * sun_sine));
  for (const V3d& direction : sphere.directions) {
    const SkyRay ray{height_m, direction.z, direction.x * sun_level + direction.z * sun_sine};
    bool ground = false;
    const double length = length_in_air(height_m, direction.z, ground);
    Spectrum left = filled(1);
    for (int k = 0; k < steps; ++k) {
      const double s = (k + 0.5) / steps, along = length * s * s, dt = length * 2 * s / steps;
      const Stop stop = stop_at(ray, sun_sine, along);
      const Step step = step_of(air, stop.height_m);
      const Spectrum light = sunlight_at(air, stop);
      for (std::size_t i = 0; i < wavelengths; ++i) {
        const float through = base::exp(-step.extinction[i] * static_cast<float>(dt));
        const float scattered_share = (step.scattered_rayleigh[i] + step.scattered_mie[i]) /
                                      std::max(1e-20f, step.extinction[i]) * (1 - through) * left[i];
        second[i] += scattered_share * light[i] / (4 * pi);
        passed_on[i] += scattered_share;
        left[i] *= through;
      }
    }
    if (ground) {
      const Stop stop = stop_at(ray, sun_sine, length);
      const Spectrum light = sunlight_at(air, {0, stop.sun_sine});
      for (std::size_t i = 0; i < wavelengths; ++i) {
        second[i] += left[i] * albedo[i] / pi * light[i] * std::max(0.0f, stop.sun_sine);
      }
    }
  }
  constexpr float share = 1.0f / (Sphere::rows * Sphere::columns);
  for (std::size_t i = 0; i < wavelengths; ++i) {
    second[i] = second[i] * share / std::max(0.02f, 1 - passed_on[i] * share);
  }
  return second;
}

}  // namespace

double length_in_air(double height_m, double sine, bool& ground) {
  const double r = earth_m + height_m, b = r * sine;
  constexpr double top = earth_m + Atmosphere::top_height_m;
  const double under = b * b - r * r + earth_m * earth_m;
  ground = sine < 0 && under >= 0;
  if (ground) return std::max(0.0, -b - std::sqrt(under));
  return std::max(0.0, -b + std::sqrt(std::max(0.0, b * b - r * r + top * top)));
}

MultipleScattering::MultipleScattering(const Atmosphere& air, double sun_sine, const Spectrum& ground_albedo) {
  // No ray in the air is longer than 11 degrees around the earth, so the sun stands no more than that higher or lower.
  constexpr double reach = 0.2;
  first_sine_ = std::max(-1.0, sun_sine - reach);
  last_sine_ = std::min(1.0, sun_sine + reach);
  table_.resize(heights_ * suns_);
  for (std::size_t row = 0; row < heights_; ++row) {
    const double s = static_cast<double>(row) / (heights_ - 1), height = Atmosphere::top_height_m * s * s;
    for (std::size_t i = 0; i < suns_; ++i) {
      const double sine = first_sine_ + (last_sine_ - first_sine_) * static_cast<double>(i) / (suns_ - 1);
      table_[row * suns_ + i] = multiple_at(air, std::max(1.0, height), sine, ground_albedo);
    }
  }
}

Spectrum MultipleScattering::at(float height_m, float sun_sine) const {
  const double y =
      std::sqrt(std::clamp(static_cast<double>(height_m) / Atmosphere::top_height_m, 0.0, 1.0)) * (heights_ - 1);
  const double x =
      std::clamp((static_cast<double>(sun_sine) - first_sine_) / (last_sine_ - first_sine_), 0.0, 1.0) * (suns_ - 1);
  const std::size_t row = std::min(static_cast<std::size_t>(y), heights_ - 2);
  const std::size_t column = std::min(static_cast<std::size_t>(x), suns_ - 2);
  const float ty = static_cast<float>(y - static_cast<double>(row));
  const float tx = static_cast<float>(x - static_cast<double>(column));
  const Spectrum* at = table_.data() + row * suns_ + column;
  Spectrum result;
  for (std::size_t i = 0; i < wavelengths; ++i) {
    const float low = at[0][i] + (at[1][i] - at[0][i]) * tx;
    const float high = at[suns_][i] + (at[suns_ + 1][i] - at[suns_][i]) * tx;
    result[i] = low + (high - low) * ty;
  }
  return result;
}

SkyLight scattered(const Atmosphere& air, const MultipleScattering& multiple, const SkyRay& ray, double sun_sine,
                   double most_m) {
  constexpr int steps = 48;
  bool ground = false;
  const double length = std::min(most_m, length_in_air(ray.height_m, ray.sine, ground));
  SkyLight result;
  Spectrum left = filled(1);
  for (int k = 0; k < steps; ++k) {
    // Short steps where the air is dense, near the eye.
    const double s = (k + 0.5) / steps, along = length * s * s, dt = length * 2 * s / steps;
    const Stop stop = stop_at(ray, sun_sine, along);
    const Step step = step_of(air, stop.height_m);
    const Spectrum light = sunlight_at(air, stop), often = multiple.at(stop.height_m, stop.sun_sine);
    for (std::size_t i = 0; i < wavelengths; ++i) {
      // The light that a step adds is weakened on its way through the step itself (Hillaire 2016).
      const float through = base::exp(-step.extinction[i] * static_cast<float>(dt));
      const float reach = left[i] * (1 - through) / std::max(1e-20f, step.extinction[i]);
      result.rayleigh[i] += reach * step.scattered_rayleigh[i] * light[i];
      result.mie[i] += reach * step.scattered_mie[i] * light[i];
      result.multiple[i] += reach * (step.scattered_rayleigh[i] + step.scattered_mie[i]) * often[i];
      result.by_rayleigh[i] += reach * step.scattered_rayleigh[i];
      result.by_mie[i] += reach * step.mie[i];
      left[i] *= through;
    }
  }
  result.transmittance = left;
  return result;
}

}  // namespace silvavis::shade
