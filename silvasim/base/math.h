// exp and log that give the same bits on every machine, for all numbers whose bytes are promised. The C library's
// differ between machines and versions; these use only + - * / and the bits of the number.
//
// Promise: error below 2 ulp against the true value wherever the result is a normal number (measured: exp below 1 ulp
//   in both widths, log below 1 ulp). exp of a value whose result would be subnormal is 0, so that a thread which flushes
//   subnormals to zero gets the same; too large gives infinity. log(0) is minus infinity, log of a negative is NaN, NaN
//   stays NaN. In a source compiled with -ffinite-math-only the infinities and NaN are not promised.
// Cost: no branch, no table, no call: gcc turns a plain loop over floats into SIMD at -O3 -fno-math-errno.
// Source: range reduction by ln 2 in two parts (Cody and Waite 1980) and near-minimax polynomials made for this file.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

namespace silvasim::base {

// `yes ? a : b` in bits, because gcc makes branches of chained comparisons of floats and then leaves the loop scalar.
inline float select(bool yes, float a, float b) {
  const std::uint32_t mask = 0u - static_cast<std::uint32_t>(yes);
  return std::bit_cast<float>((std::bit_cast<std::uint32_t>(a) & mask) | (std::bit_cast<std::uint32_t>(b) & ~mask));
}

inline double select(bool yes, double a, double b) {
  const std::uint64_t mask = 0u - static_cast<std::uint64_t>(yes);
  return std::bit_cast<double>((std::bit_cast<std::uint64_t>(a) & mask) | (std::bit_cast<std::uint64_t>(b) & ~mask));
}

// exp(x) = 2^k exp(r) with |r| <= ln(2)/2.
inline float exp(float x) {
  constexpr float least = -87.33654f, most = 89.0f;  // below: less than 2^-126; above 88.73: infinity comes by itself
  constexpr float magic = 0x1.8p23f;                 // adding it rounds to an integer, which stands in the last bits
  const float bound = select(x > most, most, x);
  const float clamped = select(bound < least, least, bound);
  const float shifted = clamped * 0x1.715476p0f + magic;
  const float k = shifted - magic;
  const float r = (clamped - k * 0x1.62e4p-1f) - k * 0x1.7f7d1cp-20f;
  const float q =
      0x1.fffffcp-2f + r * (0x1.555492p-3f + r * (0x1.5558f2p-5f + r * (0x1.123a2p-7f + r * 0x1.6a23cep-10f)));
  const float fraction = 1.0f + (r + r * r * q);
  // Scale in two steps, because 2^128 is no float though exp(88.7) is. Wrapping arithmetic keeps NaN's garbage defined.
  const std::uint32_t exponent = std::bit_cast<std::uint32_t>(shifted) - std::bit_cast<std::uint32_t>(magic);
  const std::int32_t half = static_cast<std::int32_t>(exponent) >> 1;
  const float first = std::bit_cast<float>((static_cast<std::uint32_t>(half) + 127u) << 23);
  const float second = std::bit_cast<float>((exponent - static_cast<std::uint32_t>(half) + 127u) << 23);
  const float scaled = fraction * first * second;
  return select(x < least, 0.0f, scaled);
}

inline double exp(double x) {
  constexpr double least = -708.3964185322641, most = 710.0;
  constexpr double magic = 0x1.8p52;
  const double bound = select(x > most, most, x);
  const double clamped = select(bound < least, least, bound);
  const double shifted = clamped * 0x1.71547652b82fep0 + magic;
  const double k = shifted - magic;
  const double r = (clamped - k * 0x1.62e42fep-1) - k * 0x1.f473de6af278fp-30;
  // Taylor to r^13: what is left out is below 2^-57.
  double q = 1.0 / 6227020800.0;
  q = q * r + 1.0 / 479001600.0;
  q = q * r + 1.0 / 39916800.0;
  q = q * r + 1.0 / 3628800.0;
  q = q * r + 1.0 / 362880.0;
  q = q * r + 1.0 / 40320.0;
  q = q * r + 1.0 / 5040.0;
  q = q * r + 1.0 / 720.0;
  q = q * r + 1.0 / 120.0;
  q = q * r + 1.0 / 24.0;
  q = q * r + 1.0 / 6.0;
  q = q * r + 0.5;
  const double fraction = 1.0 + (r + r * r * q);
  const std::uint64_t exponent = std::bit_cast<std::uint64_t>(shifted) - std::bit_cast<std::uint64_t>(magic);
  const std::int64_t half = static_cast<std::int64_t>(exponent) >> 1;
  const double first = std::bit_cast<double>((static_cast<std::uint64_t>(half) + 1023u) << 52);
  const double second = std::bit_cast<double>((exponent - static_cast<std::uint64_t>(half) + 1023u) << 52);
  const double scaled = fraction * first * second;
  return select(x < least, 0.0, scaled);
}

// log(x) = k ln 2 + log(m), m in [sqrt(1/2), sqrt(2)); log(1 + f) = f - s (f - 2 s^2 (1/3 + s^2/5 + ...)), s = f / (2 +
// f).
inline float log(float x) {
  constexpr std::uint32_t root_half = 0x3F3504F3u;
  const bool subnormal = x < 0x1p-126f;
  const float scaled = select(subnormal, x * 0x1p25f, x);
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(scaled) - root_half;
  const std::int32_t power = (static_cast<std::int32_t>(bits) >> 23) - 25 * static_cast<std::int32_t>(subnormal);
  const float m = std::bit_cast<float>((bits & 0x007FFFFFu) + root_half);
  const float k = static_cast<float>(power);
  const float f = m - 1.0f;
  const float s = f / (2.0f + f);
  const float z = s * s;
  const float tail = z * (2.0f / 3 + z * (2.0f / 5 + z * (2.0f / 7 + z * (2.0f / 9 + z * (2.0f / 11)))));
  const float result = k * 0x1.62e4p-1f + (f - (s * (f - tail) - k * 0x1.7f7d1cp-20f));
  constexpr float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  const float positive = select(x > std::numeric_limits<float>::max(), x, result);
  return select(x > 0.0f, positive, select(x == 0.0f, -infinity, nan));
}

inline double log(double x) {
  constexpr std::uint64_t root_half = 0x3FE6A09E667F3BCDu;
  const bool subnormal = x < 0x1p-1022;
  const double scaled = select(subnormal, x * 0x1p54, x);
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(scaled) - root_half;
  const std::int64_t power = (static_cast<std::int64_t>(bits) >> 52) - 54 * static_cast<std::int64_t>(subnormal);
  const double m = std::bit_cast<double>((bits & 0x000FFFFFFFFFFFFFu) + root_half);
  const double k = static_cast<double>(power);
  const double f = m - 1.0;
  const double s = f / (2.0 + f);
  const double z = s * s;
  double tail = 2.0 / 23;
  tail = tail * z + 2.0 / 21;
  tail = tail * z + 2.0 / 19;
  tail = tail * z + 2.0 / 17;
  tail = tail * z + 2.0 / 15;
  tail = tail * z + 2.0 / 13;
  tail = tail * z + 2.0 / 11;
  tail = tail * z + 2.0 / 9;
  tail = tail * z + 2.0 / 7;
  tail = tail * z + 2.0 / 5;
  tail = tail * z + 2.0 / 3;
  const double result = k * 0x1.62e42fep-1 + (f - (s * (f - z * tail) - k * 0x1.f473de6af278fp-30));
  constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const double positive = select(x > std::numeric_limits<double>::max(), x, result);
  return select(x > 0.0, positive, select(x == 0.0, -infinity, nan));
}

}  // namespace silvasim::base
