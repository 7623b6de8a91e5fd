// A clear sky: its light in every direction, and the sun's, for one place of the sun.
//
// Units: radiance of 1 is that of a white sheet that faces the sun of a clear summer noon (60 degrees high, 60 km of
//   visibility), about `cd_m2_per_unit`; irradiance of 1 lights a white sheet to a radiance of 1 / pi. Linear sRGB.
// Shape: a round earth, on which the scene stands; below the horizon one sees its ground through the haze.
// Promise: finite, never negative, also by night (then it is a very dark blue). Same options, same values on any thread.
//   What refraction does to the sun's place is in sun_direction(); the sky's own light goes straight.
// Errors: base::Error for a direction that is none, and a visibility that no air has.
// Threads: made on one, asked from any. Cost: 50 ms of one core once, shared among them; then 50 ns a direction.
// Source: single scattering by Bruneton and Neyret 2008, what is scattered more often by Hillaire 2020; docs/light.md
//   has what was read where, and how the sky compares with published ones.
#pragma once

#include <array>
#include <vector>

#include "silvavis/base/vector.h"
#include "silvavis/image/image.h"
#include "silvavis/shade/atmosphere.h"

namespace silvavis::shade {

struct SkyOptions {
  V3 sun_direction{0, -0.5f, 0.8660254f};  // towards it, in the scene's frame; sun_direction() makes it
  double visibility_km = 60;               // 1 to 300; at the ground, by Koschmieder
  Rgb ground_albedo{0.08f, 0.11f, 0.05f};  // of the land all around
  double eye_height_m = 2;                 // above the lowest of that land
  double land_height_m =
      2;  // at most the eye's: where the light falls on things (silvavis::Light); the mean of the land in view
};

// Light on its way to the eye in parts that vary slowly; the phase functions are put in when a direction is asked for.
struct SkyNode {
  Rgb rayleigh{0, 0, 0}, mie{0, 0, 0}, multiple{0, 0, 0};
};

// The same for an eye on the land.
inline SkyOptions at_land(SkyOptions options) {
  options.eye_height_m = options.land_height_m;
  return options;
}

class MultipleScattering;

class Sky {
 public:
  static constexpr double cd_m2_per_unit = image::cd_m2_per_unit;

  explicit Sky(const SkyOptions& options);

  const SkyOptions& options() const { return options_; }
  const V3& sun_direction() const { return options_.sun_direction; }  // unit
  const Atmosphere& air() const { return air_; }

  // What is seen in a unit direction; without the sun's disc.
  Rgb radiance(const V3& direction) const;

  // The same, with the disc: for rays from the eye, never for lighting.
  Rgb radiance_with_disc(const V3& direction) const;

  // On a sheet at the eye's height that faces the sun; 0 once the disc is below the horizon.
  const Rgb& sun_irradiance() const { return sun_irradiance_; }

  // From the sky alone, on the level ground.
  const Rgb& sky_irradiance() const { return sky_irradiance_; }

  // From sky and ground (not the sun) on a surface with that unit normal, nothing in the way; what a shape lets through
  // is for the caller to find. Nine coefficients: Ramamoorthi and Hanrahan 2001, equation 13. The error is at most 5 %
  // of what the level ground gets.
  Rgb irradiance(const V3& normal) const;

  // What the air adds along level rays, for haze.h: its light for a ray that it takes wholly, at `air_levels` heights
  // from the ground to `air_top_m` (by their square root) and the columns of `around` (by the sine of half the turn away
  // from the sun). On the ground that is the sky just above the horizon.
  static constexpr std::size_t air_levels = 6, around = 33;
  static constexpr float air_top_m = 10e3f;
  using Row = std::array<SkyNode, around>;
  const std::array<Row, air_levels>& air_light() const { return air_light_; }

 private:
  static constexpr std::size_t above_ = 60, below_ = 22;

  float across(const V3& direction) const;
  void trace();
  void trace_air(const MultipleScattering& multiple);
  void sum_up();

  SkyOptions options_;
  Atmosphere air_;
  float horizon_ = 0;                // sine of its elevation
  float level_x_ = 0, level_y_ = 0;  // the sun's azimuth
  std::vector<Row> rows_;            // above_ from the horizon up, then below_ from it down
  std::array<Row, air_levels> air_light_;
  Rgb sun_irradiance_{0, 0, 0}, sky_irradiance_{0, 0, 0};
  std::array<Rgb, 9> harmonics_;
};

}  // namespace silvavis::shade
