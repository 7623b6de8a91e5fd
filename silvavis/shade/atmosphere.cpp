#include "silvavis/shade/atmosphere.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "silvasim/base/error.h"
#include "silvasim/base/math.h"

namespace silvavis::shade {

namespace {

namespace base = silvasim::base;

constexpr double first_nm = 390, step_nm = 20;

double nm_of(std::size_t i) { return first_nm + step_nm * static_cast<double>(i); }
double power(double x, double exponent) { return base::exp(exponent * base::log(x)); }

// Above the atmosphere, W per m2 and nm, means over 20 nm from 380 nm on: ASTM G173-03.
constexpr Spectrum extraterrestrial = {1.07983f, 1.72910f, 1.65062f, 1.97336f, 2.02127f, 1.94593f, 1.87333f, 1.88080f,
                                       1.85095f, 1.83430f, 1.79814f, 1.72490f, 1.66424f, 1.56312f, 1.53376f, 1.46110f};

// Of a molecule of ozone at 233 K, in 1e-26 m2, means over the same bands: Gorshelev and Serdyuchenko et al. 2014.
constexpr Spectrum ozone_cross_section = {0.04727f, 0.2145f, 0.69855f, 1.949f, 4.2965f, 8.384f, 15.41f,  24.47f,
                                          32.955f,  44.69f,  45.495f,  46.62f, 34.775f, 24.5f,  16.625f, 10.7565f};

// The lobes of Wyman, Sloan and Shirley, Simple Analytic Approximations to the CIE XYZ Color Matching Functions (2013).
double lobe(double nm, double height, double centre, double below, double above) {
  const double t = (nm - centre) / (nm < centre ? below : above);
  return height * base::exp(-0.5 * t * t);
}

struct Weights {
  std::array<Rgb, wavelengths> rgb;

  Weights() {
    for (std::size_t i = 0; i < wavelengths; ++i) {
      const double nm = nm_of(i);
      const double x =
          lobe(nm, 1.056, 599.8, 37.9, 31.0) + lobe(nm, 0.362, 442.0, 16.0, 26.7) + lobe(nm, -0.065, 501.1, 20.4, 26.2);
      const double y = lobe(nm, 0.821, 568.8, 46.9, 40.5) + lobe(nm, 0.286, 530.9, 16.3, 31.1);
      const double z = lobe(nm, 1.217, 437.0, 11.8, 36.0) + lobe(nm, 0.681, 459.0, 26.0, 13.8);
      // IEC 61966-2-1
      rgb[i] = Rgb(static_cast<float>(step_nm * (3.2406 * x - 1.5372 * y - 0.4986 * z)),
                   static_cast<float>(step_nm * (-0.9689 * x + 1.8758 * y + 0.0415 * z)),
                   static_cast<float>(step_nm * (0.0557 * x - 0.2040 * y + 1.0570 * z)));
    }
  }
};

// From a point upwards to the top. Steps grow with the distance, because the air is densest at the start.
Columns integrated(double radius_m, double cosine) {
  constexpr double top = Atmosphere::ground_radius_m + Atmosphere::top_height_m;
  const double b = radius_m * cosine;
  const double length = -b + std::sqrt(std::max(0.0, b * b + top * top - radius_m * radius_m));
  constexpr int steps = 64;
  double rayleigh = 0, mie = 0, ozone = 0, aloft = 0;
  for (int i = 0; i < steps; ++i) {
    const double s = (i + 0.5) / steps, t = length * s * s, dt = length * 2 * s / steps;
    const double height = std::sqrt(radius_m * radius_m + t * t + 2 * t * b) - Atmosphere::ground_radius_m;
    const Columns density = Atmosphere::densities(static_cast<float>(height));
    rayleigh += dt * static_cast<double>(density.rayleigh);
    mie += dt * static_cast<double>(density.mie);
    ozone += dt * static_cast<double>(density.ozone);
    aloft += dt * static_cast<double>(density.aloft);
  }
  return {static_cast<float>(rayleigh), static_cast<float>(mie), static_cast<float>(ozone), static_cast<float>(aloft)};
}

// A ray that goes down first and passes the earth: both ways from its lowest point, less what lies behind the start.
Columns whole_path(double radius_m, double cosine) {
  if (cosine >= 0) return integrated(radius_m, cosine);
  const double lowest = std::max(Atmosphere::ground_radius_m, radius_m * std::sqrt(1 - cosine * cosine));
  const Columns half = integrated(lowest, 0), behind = integrated(radius_m, -cosine);
  return {2 * half.rayleigh - behind.rayleigh, 2 * half.mie - behind.mie, 2 * half.ozone - behind.ozone,
          2 * half.aloft - behind.aloft};
}

Columns mixed(const Columns& a, const Columns& b, float t) {
  return {a.rayleigh + (b.rayleigh - a.rayleigh) * t, a.mie + (b.mie - a.mie) * t, a.ozone + (b.ozone - a.ozone) * t,
          a.aloft + (b.aloft - a.aloft) * t};
}

}  // namespace

Spectrum filled(float value) {
  Spectrum result;
  result.fill(value);
  return result;
}

Rgb rgb_of(const Spectrum& spectrum) {
  static const Weights weights;
  Rgb sum(0, 0, 0);
  for (std::size_t i = 0; i < wavelengths; ++i) sum += weights.rgb[i] * spectrum[i];
  return sum;
}

Spectrum spectrum_of(const Rgb& albedo) {
  Spectrum result;
  for (std::size_t i = 0; i < wavelengths; ++i) {
    const double nm = nm_of(i);
    result[i] = nm < 495 ? albedo.z : nm < 585 ? albedo.y : albedo.x;
  }
  return result;
}

double horizon_cosine(double height_m) {
  const double ratio = Atmosphere::ground_radius_m / (Atmosphere::ground_radius_m + std::max(0.0, height_m));
  return -std::sqrt(1 - ratio * ratio);
}

Columns Atmosphere::densities(float height_m) {
  const float h = std::max(0.0f, height_m);
  // Aloft: what the wind mixes up to the tropopause, and the layer of quiet years above it.
  const float stratosphere = std::clamp(std::min((h - 8e3f) / 3e3f, (28e3f - h) / 8e3f), 0.0f, 1.0f);
  const float troposphere =
      12 * std::clamp((h - 3.5e3f) / 1.5e3f, 0.0f, 1.0f) * base::exp(-std::max(0.0f, h - 5e3f) / 1950);
  return {base::exp(-h / static_cast<float>(rayleigh_height_m)), base::exp(-h / static_cast<float>(mie_height_m)),
          std::max(0.0f, 1 - std::abs(h - 25e3f) / 15e3f), stratosphere + troposphere};
}

Atmosphere::Atmosphere(double visibility_km) : sun_(extraterrestrial) {
  constexpr double least_km = 1, most_km = 300;
  if (!(visibility_km >= least_km && visibility_km <= most_km)) {
    throw base::Error(fmt::format("the visibility is {} km; it can be {} (mist) to {} (the purest air)", visibility_km,
                                  least_km, most_km));
  }
  // The column of molecules of the whole atmosphere (Hansen and Travis 1974), spread over its height.
  const auto rayleigh_per_m = [](double nm) {
    const double l2 = 1e6 / (nm * nm);
    return 0.008569 * l2 * l2 * (1 + 0.0113 * l2 + 0.00013 * l2 * l2) / rayleigh_height_m;
  };
  // Koschmieder: a black thing is just seen where 2 % of its contrast is left, for the green light of 550 nm.
  const double mie_per_m = 3.912 / (visibility_km * 1000) - rayleigh_per_m(550);
  // Between 11 and 20 km: the mean of LOWTRAN 7's profile; at 5 km 12 times that, between its winter
  // and its summer (Kneizys et al. 1988).
  constexpr double aloft_per_m = 4.8e-7;
  constexpr double angstrom = 1.3, scattered_share = 0.93;
  constexpr double ozone_molecules_m2 = 300 * 2.687e20, ozone_layer_m = 15e3;  // 300 Dobson units
  for (std::size_t i = 0; i < wavelengths; ++i) {
    const double nm = nm_of(i);
    const double mie = mie_per_m * power(nm / 550, -angstrom);
    rayleigh_[i] = static_cast<float>(rayleigh_per_m(nm));
    mie_[i] = static_cast<float>(mie);
    aloft_[i] = static_cast<float>(aloft_per_m * power(nm / 550, -angstrom));
    mie_scattered_[i] = static_cast<float>(mie * scattered_share);
    ozone_[i] =
        static_cast<float>(static_cast<double>(ozone_cross_section[i]) * 1e-26 * ozone_molecules_m2 / ozone_layer_m);
  }
  // Heights by their root; directions by the distance to the top, which resolves the horizon (Bruneton and Neyret 2008,
  // in the form of 2017).
  to_top_.resize(rows_ * columns_);
  constexpr double top = ground_radius_m + top_height_m;
  for (std::size_t row = 0; row < rows_; ++row) {
    const double s = static_cast<double>(row) / (rows_ - 1), height = top_height_m * s * s;
    const double r = ground_radius_m + height, rho = std::sqrt(r * r - ground_radius_m * ground_radius_m);
    const double nearest = top_height_m - height;
    const double farthest = rho + std::sqrt(top * top - ground_radius_m * ground_radius_m);
    for (std::size_t column = 0; column < columns_; ++column) {
      const double x = static_cast<double>(column) / (columns_ - 1);
      const double d = nearest + x * (farthest - nearest);
      const double cosine = d > 0 ? (top * top - r * r - d * d) / (2 * r * d) : 1;
      to_top_[row * columns_ + column] = whole_path(r, std::clamp(cosine, -1.0, 1.0));
    }
  }
}

Columns Atmosphere::to_top(float height_m, float cosine) const {
  constexpr double top = ground_radius_m + top_height_m;
  const double height = std::clamp(static_cast<double>(height_m), 0.0, top_height_m), r = ground_radius_m + height;
  const double mu = std::max(static_cast<double>(cosine), horizon_cosine(height));
  const double rho = std::sqrt(r * r - ground_radius_m * ground_radius_m);
  const double nearest = top_height_m - height;
  const double farthest = rho + std::sqrt(top * top - ground_radius_m * ground_radius_m);
  const double d = -r * mu + std::sqrt(std::max(0.0, r * r * (mu * mu - 1) + top * top));
  const double x = std::clamp((d - nearest) / (farthest - nearest), 0.0, 1.0) * (columns_ - 1);
  const double y = std::sqrt(height / top_height_m) * (rows_ - 1);
  const std::size_t column = std::min(static_cast<std::size_t>(x), columns_ - 2);
  const std::size_t row = std::min(static_cast<std::size_t>(y), rows_ - 2);
  const float tx = static_cast<float>(x - static_cast<double>(column));
  const float ty = static_cast<float>(y - static_cast<double>(row));
  const Columns* at = to_top_.data() + row * columns_ + column;
  return mixed(mixed(at[0], at[1], tx), mixed(at[columns_], at[columns_ + 1], tx), ty);
}

float Atmosphere::share_of_sun(float height_m, float cosine) {
  const double horizon = horizon_cosine(static_cast<double>(height_m));
  // Near the horizon a difference of cosines is one of angles, but for the horizon's sine.
  const double above = (static_cast<double>(cosine) - horizon) / std::sqrt(1 - horizon * horizon);
  const double x = above / sun_radius_rad;
  if (x <= -1) return 0;
  if (x >= 1) return 1;
  // The disc's part above a line at distance x from its centre.
  return static_cast<float>(0.5 + (std::asin(x) + x * std::sqrt(1 - x * x)) / 3.14159265358979);
}

Spectrum Atmosphere::transmittance(const Columns& columns) const {
  Spectrum result;
  for (std::size_t i = 0; i < wavelengths; ++i) {
    result[i] = base::exp(-(rayleigh_[i] * columns.rayleigh + mie_[i] * columns.mie + ozone_[i] * columns.ozone +
                            aloft_[i] * columns.aloft));
  }
  return result;
}

}  // namespace silvavis::shade
