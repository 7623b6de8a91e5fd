// The clear air around the earth: how much it scatters and absorbs, wavelength by wavelength and height by height.
//
// Lengths in metres, heights above the ground of a round earth. Light in W per m2 and nm; wavelengths in nm.
// Made of air molecules (Rayleigh), haze (Mie) and ozone; what stands for what, and from where, is in docs/light.md.
// Errors: base::Error for a visibility that no air has. Threads: any, once made. Cost: 10 ms.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "silvavis/base/vector.h"

namespace silvavis::shade {

inline constexpr std::size_t wavelengths = 16;  // 390, 410 ... 690 nm, each for the 20 nm around it
using Spectrum = std::array<float, wavelengths>;
Spectrum filled(float value);

// From light of that spectrum to linear sRGB, where 683 * luminance is what photometry says (cd/m2 for radiance).
Rgb rgb_of(const Spectrum& spectrum);

// A spectrum of that colour for surfaces: each band takes its channel.
Spectrum spectrum_of(const Rgb& albedo);

// What a path goes through, as metres of the density at the ground.
struct Columns {
  float rayleigh = 0, mie = 0, ozone = 0;
  float aloft = 0;  // the fine haze above 3.5 km, whatever the visibility at the ground
};

// Scattered light over the sphere: integrates to 1. `cosine` of the angle between the light's way and the eye's.
inline constexpr float pi = 3.14159265f;
inline constexpr float mie_g = 0.8f;
inline float rayleigh_phase(float cosine) { return 3 / (16 * pi) * (1 + cosine * cosine); }
inline float mie_phase(float cosine) {  // Cornette and Shanks 1992
  constexpr float g = mie_g, scale = 3 / (8 * pi) * (1 - g * g) / (2 + g * g);
  const float d = 1 + g * g - 2 * g * cosine;  // at least (1 - g)^2, or a little less by rounding
  return scale * (1 + cosine * cosine) / (d * std::sqrt(d));
}

class Atmosphere {
 public:
  static constexpr double ground_radius_m = 6360e3, top_height_m = 100e3;
  static constexpr double rayleigh_height_m = 8400, mie_height_m = 1200;
  static constexpr double sun_radius_rad = 0.004654;  // of its disc, as seen from the earth

  explicit Atmosphere(double visibility_km);

  // Above the atmosphere, on a sheet that faces the sun.
  const Spectrum& sun() const { return sun_; }
  // Per metre, at density 1.
  const Spectrum& rayleigh() const { return rayleigh_; }
  const Spectrum& mie_scattered() const { return mie_scattered_; }
  const Spectrum& mie() const { return mie_; }  // scattered and absorbed
  const Spectrum& ozone() const { return ozone_; }
  const Spectrum& aloft() const { return aloft_; }  // scattered alone, like haze

  static Columns densities(float height_m);

  // From a height to the top of the atmosphere in a direction with that cosine to the vertical. A ray that would touch
  // the ground is taken to graze it.
  Columns to_top(float height_m, float cosine) const;

  // The share of the sun's disc above the horizon of a point at that height.
  static float share_of_sun(float height_m, float cosine);

  // exp(-optical depth)
  Spectrum transmittance(const Columns& columns) const;

 private:
  static constexpr std::size_t rows_ = 48, columns_ = 96;

  Spectrum sun_, rayleigh_, mie_scattered_, mie_, ozone_, aloft_;
  std::vector<Columns> to_top_;  // rows_ heights, columns_ directions
};

// Cosine of the direction in which a point at that height sees the horizon.
double horizon_cosine(double height_m);

}  // namespace silvavis::shade
