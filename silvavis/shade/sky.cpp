#include "silvavis/shade/sky.h"

#include <algorithm>
#include <cmath>

#include "silvasim/base/error.h"
#include "silvasim/base/parallel.h"
#include "silvavis/shade/scattering.h"

namespace silvavis::shade {

namespace {

constexpr float per_unit = static_cast<float>(683.0 / Sky::cd_m2_per_unit);

// The white of noon: what a camera does that is set to daylight. A white sheet that faces the sun of a clear noon is then
// white; in the colours of sRGB's own white it would be yellowish, and its shade less blue.
const Rgb daylight(0.90655f, 1.01971f, 1.12617f);

// About the light of a full moon on air: what is left when the sun is far below the horizon.
const Rgb night(0.5e-6f, 0.8e-6f, 1.8e-6f);

Rgb lit(const Atmosphere& air, Spectrum spectrum) {
  for (std::size_t i = 0; i < wavelengths; ++i) spectrum[i] *= air.sun()[i];
  return rgb_of(spectrum) * daylight * per_unit;
}

// Light outside of what a screen can show has a negative share of a primary.
Rgb positive(const Rgb& colour) {
  return Rgb(std::max(0.0f, colour.x), std::max(0.0f, colour.y), std::max(0.0f, colour.z));
}

Rgb mix(const Rgb& a, const Rgb& b, float t) { return a + (b - a) * t; }
SkyNode mix(const SkyNode& a, const SkyNode& b, float t) {
  return {mix(a.rayleigh, b.rayleigh, t), mix(a.mie, b.mie, t), mix(a.multiple, b.multiple, t)};
}

SkyOptions checked(SkyOptions options) {
  const float length = options.sun_direction.length();
  if (!(length > 0.5f && length < 2)) throw silvasim::base::Error("the sky's sun direction is no unit vector");
  options.sun_direction /= length;
  if (!(options.eye_height_m < 50e3)) throw silvasim::base::Error("the sky's eye is above the sky (at most 50 km)");
  options.eye_height_m = std::max(2.0, options.eye_height_m);
  for (const float share : {options.ground_albedo.x, options.ground_albedo.y, options.ground_albedo.z}) {
    if (!(share >= 0 && share <= 1)) throw silvasim::base::Error("the sky's ground albedo is not within 0 to 1");
  }
  return options;
}

}  // namespace

Sky::Sky(const SkyOptions& options) : options_(checked(options)), air_(options.visibility_km) {
  horizon_ = static_cast<float>(horizon_cosine(options_.eye_height_m));
  const V3& sun = options_.sun_direction;
  const float level = std::sqrt(sun.x * sun.x + sun.y * sun.y);
  if (level > 1e-6f) {
    level_x_ = sun.x / level;
    level_y_ = sun.y / level;
  }
  trace();
  sum_up();
}

// Rows over the elevation, dense at the horizon; columns over half of the turn away from the sun, by the sine of half
// the angle.
void Sky::trace() {
  const double sun_sine = static_cast<double>(options_.sun_direction.z);
  const double sun_level = std::sqrt(std::max(0.0, 1 - sun_sine * sun_sine)), horizon = static_cast<double>(horizon_);
  const Spectrum albedo = spectrum_of(options_.ground_albedo);
  const MultipleScattering multiple(air_, sun_sine, albedo);
  constexpr double endless = 1e9;
  const auto trace_row = [&](double sine, Row& row, const auto& add_ground) {
    const double level = std::sqrt(std::max(0.0, 1 - sine * sine));
    for (std::size_t i = 0; i < around; ++i) {
      const double u = static_cast<double>(i) / (around - 1), aroundcosine = 1 - 2 * u * u;
      const SkyRay ray{options_.eye_height_m, sine, level * sun_level * aroundcosine + sine * sun_sine};
      SkyLight light = scattered(air_, multiple, ray, sun_sine, endless);
      add_ground(ray, light);
      row[i] = {lit(air_, light.rayleigh), lit(air_, light.mie), lit(air_, light.multiple)};
    }
  };
  const auto no_ground = [](const SkyRay&, SkyLight&) {};
  constexpr double just_above = 1e-6;

  // The ground around is lit by the sun and, as far as one table tells it, by the sky.
  const auto ground = [&](const SkyRay& ray, SkyLight& light) {
    bool hit = false;
    const double length = length_in_air(ray.height_m, ray.sine, hit);
    const double r = Atmosphere::ground_radius_m + ray.height_m;
    const double sine = std::clamp((r * sun_sine + length * ray.sun_cosine) / Atmosphere::ground_radius_m, -1.0, 1.0);
    const Spectrum direct = air_.transmittance(air_.to_top(0, static_cast<float>(sine)));
    const Spectrum often = multiple.at(0, static_cast<float>(sine));
    const float share =
        Atmosphere::share_of_sun(0, static_cast<float>(sine)) * std::max(0.0f, static_cast<float>(sine));
    for (std::size_t i = 0; i < wavelengths; ++i) {
      light.multiple[i] += light.transmittance[i] * albedo[i] / pi * (direct[i] * share + 2 * pi * often[i]);
    }
  };
  // Each row by itself, so that threads do not matter.
  rows_.resize(above_ + below_);
  silvasim::base::parallel_for(rows_.size(), [&](std::size_t i) {
    const bool up = i < above_;
    const double t = up ? static_cast<double>(i) / (above_ - 1) : static_cast<double>(i - above_) / (below_ - 1);
    if (up) {
      trace_row(std::min(1.0, horizon + just_above + (1 - horizon) * t * t), rows_[i], no_ground);
    } else {
      trace_row(std::max(-1.0, horizon - just_above - (1 + horizon) * t * t), rows_[i], ground);
    }
  });
  trace_air(multiple);

  const float eye = static_cast<float>(options_.eye_height_m), sine = options_.sun_direction.z;
  Spectrum direct = air_.transmittance(air_.to_top(eye, sine));
  for (float& value : direct) value *= Atmosphere::share_of_sun(eye, sine);
  sun_irradiance_ = positive(lit(air_, direct));
}

void Sky::trace_air(const MultipleScattering& multiple) {
  const double sun_sine = static_cast<double>(options_.sun_direction.z);
  const double sun_level = std::sqrt(std::max(0.0, 1 - sun_sine * sun_sine));
  const Rgb sun = lit(air_, filled(1));
  // What is taken may be so little that its rounding shows.
  const auto over = [&](const Rgb& light, const Spectrum& taken) {
    const Rgb share = lit(air_, taken) / sun;
    return light / Rgb(std::max(share.x, 1e-6f), std::max(share.y, 1e-6f), std::max(share.z, 1e-6f));
  };
  for (std::size_t level = 0; level < air_levels; ++level) {
    const double s = static_cast<double>(level) / (air_levels - 1);
    const double height_m = std::max(2.0, static_cast<double>(air_top_m) * s * s);
    const double sine = level == 0 ? horizon_cosine(height_m) + 1e-6 : 0, most_m = level == 0 ? 1e9 : 60e3;
    for (std::size_t i = 0; i < around; ++i) {
      const double u = static_cast<double>(i) / (around - 1);
      const SkyRay ray{height_m, sine, std::sqrt(1 - sine * sine) * sun_level * (1 - 2 * u * u) + sine * sun_sine};
      const SkyLight light = scattered(air_, multiple, ray, sun_sine, most_m);
      Spectrum taken;
      for (std::size_t k = 0; k < wavelengths; ++k) taken[k] = 1 - light.transmittance[k];
      air_light_[level][i] = {over(lit(air_, light.rayleigh), light.by_rayleigh),
                              over(lit(air_, light.mie), light.by_mie), over(lit(air_, light.multiple), taken)};
    }
  }
}

void Sky::sum_up() {
  // Equal shares of the sphere. The turn by one column is a product with a constant, which keeps the bits.
  constexpr std::size_t rows = 128, columns = 64;
  constexpr double turn_cosine = 0.9951847266721969, turn_sine = 0.0980171403295606;  // 2 pi / 64
  constexpr double share = 4 * 3.14159265358979 / (rows * columns);
  std::array<V3d, 9> sums;
  sums.fill(V3d(0, 0, 0));
  V3d level_sum(0, 0, 0);
  for (std::size_t row = 0; row < rows; ++row) {
    const double z = (2.0 * static_cast<double>(row) + 1) / rows - 1, level = std::sqrt(1 - z * z);
    double c = 1, s = 0;
    for (std::size_t i = 0; i < columns; ++i) {
      const V3d d(c * level, s * level, z);
      const Rgb light = radiance(V3(d));
      const V3d weighted =
          V3d(static_cast<double>(light.x), static_cast<double>(light.y), static_cast<double>(light.z)) * share;
      // Real spherical harmonics, Ramamoorthi and Hanrahan 2001, equation 3.
      const std::array<double, 9> y = {0.282095,
                                       0.488603 * d.y,
                                       0.488603 * d.z,
                                       0.488603 * d.x,
                                       1.092548 * d.x * d.y,
                                       1.092548 * d.y * d.z,
                                       0.315392 * (3 * d.z * d.z - 1),
                                       1.092548 * d.x * d.z,
                                       0.546274 * (d.x * d.x - d.y * d.y)};
      for (std::size_t k = 0; k < 9; ++k) sums[k] += weighted * y[k];
      if (z > 0) level_sum += weighted * z;
      const double turned = c * turn_cosine - s * turn_sine;
      s = s * turn_cosine + c * turn_sine;
      c = turned;
    }
  }
  // The cosine's own coefficients (their equation 8), with the constants of the harmonics put in.
  constexpr std::array<double, 9> lobe = {3.141593 * 0.282095, 2.094395 * 0.488603, 2.094395 * 0.488603,
                                          2.094395 * 0.488603, 0.785398 * 1.092548, 0.785398 * 1.092548,
                                          0.785398 * 0.315392, 0.785398 * 1.092548, 0.785398 * 0.546274};
  for (std::size_t k = 0; k < 9; ++k) harmonics_[k] = Rgb(sums[k] * lobe[k]);
  sky_irradiance_ = Rgb(level_sum);
}

Rgb Sky::irradiance(const V3& n) const {
  const std::array<Rgb, 9>& h = harmonics_;
  return positive(h[0] + h[1] * n.y + h[2] * n.z + h[3] * n.x + h[4] * (n.x * n.y) + h[5] * (n.y * n.z) +
                  h[6] * (3 * n.z * n.z - 1) + h[7] * (n.x * n.z) + h[8] * (n.x * n.x - n.y * n.y));
}

// The column, with its fraction, that a direction falls into.
float Sky::across(const V3& d) const {
  const float level = std::sqrt(d.x * d.x + d.y * d.y);
  const float cosine = level > 1e-6f ? (d.x * level_x_ + d.y * level_y_) / level : 1;
  const float u = std::sqrt(std::clamp((1 - cosine) * 0.5f, 0.0f, 1.0f));
  return u * (around - 1);
}

Rgb Sky::radiance(const V3& d) const {
  const bool up = d.z >= horizon_;
  const float t = up ? (d.z - horizon_) / (1 - horizon_) : (horizon_ - d.z) / (1 + horizon_);
  const float y = std::sqrt(std::clamp(t, 0.0f, 1.0f)) * static_cast<float>((up ? above_ : below_) - 1);
  const float x = across(d);
  const std::size_t row = std::min(static_cast<std::size_t>(y), (up ? above_ : below_) - 2);
  const std::size_t column = std::min(static_cast<std::size_t>(x), around - 2);
  const Row* at = rows_.data() + (up ? 0 : above_) + row;
  const float tx = x - static_cast<float>(column), ty = y - static_cast<float>(row);
  const SkyNode node = mix(mix(at[0][column], at[0][column + 1], tx), mix(at[1][column], at[1][column + 1], tx), ty);
  const float cosine = d.dot(options_.sun_direction);
  return positive(node.rayleigh * rayleigh_phase(cosine) + node.mie * mie_phase(cosine) + node.multiple) + night;
}

Rgb Sky::radiance_with_disc(const V3& d) const {
  const Rgb sky = radiance(d);
  constexpr float radius = static_cast<float>(Atmosphere::sun_radius_rad);
  // For small angles the chord is the angle, and more exact than the cosine.
  const float away = (d - options_.sun_direction).length();
  if (away >= radius || d.z < horizon_) return sky;
  // Its edge is darker (limb darkening with a coefficient of 0.6, whose mean over the disc is 0.8).
  const float edge = std::sqrt(std::max(0.0f, 1 - away * away / (radius * radius)));
  const float share =
      std::max(0.05f, Atmosphere::share_of_sun(static_cast<float>(options_.eye_height_m), options_.sun_direction.z));
  return sky + sun_irradiance_ * ((1 - 0.6f * (1 - edge)) / (0.8f * share * pi * radius * radius));
}

}  // namespace silvavis::shade
