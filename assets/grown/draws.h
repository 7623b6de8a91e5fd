// Random draws and angles with the same bits on every machine: the C library's sine and cosine differ between them.
#pragma once

#include <cmath>
#include <cstdint>

#include "assets/vector.h"
#include "silvasim/base/math.h"
#include "silvasim/base/random.h"

namespace assets::grown {

inline constexpr float pi = 3.14159265f;

struct SinCos {
  float sin = 0, cos = 1;
};

// Taylor to x^13 after reduction to [-pi/4, pi/4]: error below 1e-7 for |x| < 1e5.
inline SinCos sin_cos(float angle) {
  const double quarters = std::floor(static_cast<double>(angle) * 0.63661977236758134 + 0.5);
  const double x = static_cast<double>(angle) - quarters * 1.5707963267948966;
  const double y = x * x;
  const double s = x * (1 + y * (-1.0 / 6 + y * (1.0 / 120 + y * (-1.0 / 5040 + y * (1.0 / 362880 - y / 39916800)))));
  const double c = 1 + y * (-0.5 + y * (1.0 / 24 + y * (-1.0 / 720 + y * (1.0 / 40320 - y / 3628800))));
  switch (static_cast<std::int64_t>(quarters) & 3) {
    case 0:
      return {static_cast<float>(s), static_cast<float>(c)};
    case 1:
      return {static_cast<float>(c), static_cast<float>(-s)};
    case 2:
      return {static_cast<float>(-s), static_cast<float>(-c)};
    default:
      return {static_cast<float>(-c), static_cast<float>(s)};
  }
}
inline float sine(float angle) { return sin_cos(angle).sin; }
inline float cosine(float angle) { return sin_cos(angle).cos; }
inline float radians(float degrees) { return degrees * (pi / 180); }

// x^p for x >= 0
inline float power(float x, float p) { return x <= 0 ? 0 : silvasim::base::exp(p * silvasim::base::log(x)); }
inline float mix(float a, float b, float share) { return a + (b - a) * share; }
inline V3 mix(const V3& a, const V3& b, float share) { return a + (b - a) * share; }
inline Rgb mix(const Rgb& a, const Rgb& b, float share) {
  return {mix(a.x, b.x, share), mix(a.y, b.y, share), mix(a.z, b.z, share)};
}
inline float clamp01(float x) { return x < 0 ? 0 : x > 1 ? 1 : x; }
inline float smooth(float low, float high, float x) {
  const float t = clamp01((x - low) / (high - low));
  return t * t * (3 - 2 * t);
}

inline float length_of(const V3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }
inline V3 unit(const V3& v, const V3& otherwise = V3(0, 0, 1)) {
  const float l = length_of(v);
  return l > 1e-12f ? v * (1 / l) : otherwise;
}
// Some direction at right angles to `d`.
inline V3 across(const V3& d) { return unit(std::abs(d.z) < 0.9f ? d.cross(V3(0, 0, 1)) : d.cross(V3(1, 0, 0))); }
// The part of `v` at right angles to the unit `d`, of unit length.
inline V3 beside(const V3& v, const V3& d) {
  const V3 rest = v - d * v.dot(d);
  return length_of(rest) > 1e-4f ? unit(rest) : across(d);
}

class Draws {
 public:
  explicit Draws(std::uint64_t seed, std::uint32_t a = 0, std::uint32_t b = 0, std::uint32_t c = 0)
      : stream_(seed, silvasim::base::Purpose::plant_form, a, b, c) {}
  float share() { return stream_.next_float(); }
  float between(float low, float high) { return mix(low, high, share()); }
  float around(float centre, float spread) { return centre + spread * (2 * share() - 1); }
  // Close to a normal distribution of deviation 1 (three uniform draws).
  float bell() { return 2 * (share() + share() + share() - 1.5f); }
  V3 direction() {
    const float z = around(0, 1), r = std::sqrt(1 - z * z);
    const SinCos a = sin_cos(2 * pi * share());
    return {r * a.cos, r * a.sin, z};
  }

 private:
  silvasim::base::Stream stream_;
};

}  // namespace assets::grown
