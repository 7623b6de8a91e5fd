// How light finds its way through the air to an eye: the integrals behind sky.h.
#pragma once

#include <vector>

#include "silvavis/shade/atmosphere.h"
#include "silvavis/shade/sky.h"

namespace silvavis::shade {

// Light that was scattered more than once, as the mean radiance around a point, for a sun of 1 in every wavelength: a
// table over heights and the sun's elevation near the given one.
// Source: Hillaire 2020, A Scalable and Production Ready Sky and Atmosphere Rendering Technique, section 5.5.
class MultipleScattering {
 public:
  MultipleScattering(const Atmosphere& air, double sun_sine, const Spectrum& ground_albedo);

  Spectrum at(float height_m, float sun_sine) const;

 private:
  static constexpr std::size_t heights_ = 10, suns_ = 11;
  double first_sine_ = 0, last_sine_ = 0;
  std::vector<Spectrum> table_;
};

// A ray from `height_m` in a direction whose sine of elevation is `sine`; `sun_cosine` is the cosine of the angle to
// the sun.
struct SkyRay {
  double height_m, sine, sun_cosine;
};

// What reaches the eye; all for a sun of 1 in every wavelength, the phase functions of single scattering left out.
struct SkyLight {
  Spectrum rayleigh{}, mie{}, multiple{};
  Spectrum transmittance{};          // of the whole ray
  Spectrum by_rayleigh{}, by_mie{};  // what each takes from a light that comes along the ray: shares of 1
};

// Up to the top of the atmosphere, or down to the ground, or as far as `most_m`.
SkyLight scattered(const Atmosphere& air, const MultipleScattering& multiple, const SkyRay& ray, double sun_sine,
                   double most_m);

// Length of the ray in the air; `ground` tells whether it ends there.
double length_in_air(double height_m, double sine, bool& ground);

}  // namespace silvavis::shade
