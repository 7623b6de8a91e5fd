// Angles that give the same bits on every machine, from + - * / and square roots alone.
//
// Promise: error below 4 ulp. arctangent(y, x) is in (-pi, pi], and 0 for (0, 0).
// Source: halving, atan(t) = 2 atan(t / (1 + sqrt(1 + t^2))), until the alternating series needs ten terms.
#pragma once

#include <cmath>

namespace silvasim::fields {

constexpr double pi = 3.14159265358979323846;

inline double arctangent(double t) {
  const bool steep = t > 1 || t < -1;
  double a = steep ? 1 / t : t;
  a = a / (1 + std::sqrt(1 + a * a));  // |a| <= tan(pi/8)
  a = a / (1 + std::sqrt(1 + a * a));  // |a| <= tan(pi/16) = 0.199
  const double z = a * a;
  double series = 0;
  for (int n = 21; n >= 1; n -= 2) series = 1.0 / n - z * series;
  const double angle = 4 * a * series;
  return steep ? (t > 0 ? pi / 2 : -pi / 2) - angle : angle;
}

inline double arctangent(double y, double x) {
  if (x == 0) return y > 0 ? pi / 2 : y < 0 ? -pi / 2 : 0;
  const double angle = arctangent(y / x);
  return x > 0 ? angle : y >= 0 ? angle + pi : angle - pi;
}

}  // namespace silvasim::fields
