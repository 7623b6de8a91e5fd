// exp and log against the C library's in the next wider type, over all magnitudes.
#include "silvasim/base/math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "silvasim/base/random.h"

namespace silvasim {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr double infinity_d = std::numeric_limits<double>::infinity();

// Distance in units in the last place of T at `truth`.
template <typename T, typename Wide>
double ulps(T value, Wide truth) {
  int exponent = 0;
  std::frexp(truth, &exponent);
  const Wide ulp = std::ldexp(Wide{1}, exponent - std::numeric_limits<T>::digits);
  return static_cast<double>(std::fabs((static_cast<Wide>(value) - truth) / ulp));
}

TEST(Exp, FloatIsWithinTwoUlp) {
  double worst = 0;
  float at = 0;
  for (std::uint32_t bits = 0; bits < 0x42B20000u; bits += 457) {
    for (const std::uint32_t sign : {0u, 0x80000000u}) {
      const float x = std::bit_cast<float>(bits | sign);
      const double truth = std::exp(static_cast<double>(x));
      if (truth < 0x1p-126 || truth > static_cast<double>(std::numeric_limits<float>::max())) continue;
      const double error = ulps(base::exp(x), truth);
      if (error > worst) worst = error, at = x;
    }
  }
  RecordProperty("worst_ulp", std::to_string(worst));
  EXPECT_LT(worst, 1.1) << "at " << at;
}

TEST(Exp, DoubleIsWithinTwoUlp) {
  static_assert(std::numeric_limits<long double>::digits >= 53);
  base::Stream random(1, base::Purpose::tiling);
  double worst = 0, at = 0;
  for (int i = 0; i < 2'000'000; ++i) {
    // Half of them over the whole range, half near zero.
    const double u = 2 * random.next_double() - 1;
    const double x = (i & 1) != 0 ? 708.3 * u : std::ldexp(u, -static_cast<int>(random.next_below(60)));
    const double error = ulps(base::exp(x), std::exp(static_cast<long double>(x)));
    if (error > worst) worst = error, at = x;
  }
  RecordProperty("worst_ulp", std::to_string(worst));
  EXPECT_LT(worst, 1.1) << "at " << at;
}

TEST(Log, FloatIsWithinTwoUlp) {
  double worst = 0;
  float at = 0;
  for (std::uint32_t bits = 1; bits < 0x7F800000u; bits += 457) {
    const float x = std::bit_cast<float>(bits);
    if (x == 1.0f) continue;
    const double error = ulps(base::log(x), std::log(static_cast<double>(x)));
    if (error > worst) worst = error, at = x;
  }
  RecordProperty("worst_ulp", std::to_string(worst));
  EXPECT_LT(worst, 1.1) << "at " << at;
}

TEST(Log, DoubleIsWithinTwoUlp) {
  base::Stream random(2, base::Purpose::tiling);
  double worst = 0, at = 0;
  for (int i = 0; i < 2'000'000; ++i) {
    const double u = 1 + random.next_double();
    const double x =
        (i & 1) != 0 ? std::ldexp(u, static_cast<int>(random.next_below(2096)) - 1073) : 0.5 + random.next_double();
    const double error = ulps(base::log(x), std::log(static_cast<long double>(x)));
    if (error > worst) worst = error, at = x;
  }
  RecordProperty("worst_ulp", std::to_string(worst));
  EXPECT_LT(worst, 1.1) << "at " << at;
}

TEST(Exp, EndsAreThoseOfTheHeader) {
  EXPECT_EQ(base::exp(0.0f), 1.0f);
  EXPECT_EQ(base::exp(-0.0f), 1.0f);
  EXPECT_EQ(base::exp(0.0), 1.0);
  EXPECT_EQ(base::exp(89.0f), infinity);
  EXPECT_EQ(base::exp(infinity), infinity);
  EXPECT_LT(base::exp(88.72283f), infinity);
  EXPECT_EQ(base::exp(-infinity), 0.0f);
  EXPECT_EQ(base::exp(-87.4f), 0.0f) << "a subnormal result is flushed";
  EXPECT_GE(base::exp(-87.3365f), std::numeric_limits<float>::min());
  EXPECT_TRUE(std::isnan(base::exp(std::numeric_limits<float>::quiet_NaN())));
  EXPECT_EQ(base::exp(710.0), infinity_d);
  EXPECT_EQ(base::exp(infinity_d), infinity_d);
  EXPECT_EQ(base::exp(-infinity_d), 0.0);
  EXPECT_EQ(base::exp(-708.5), 0.0);
  EXPECT_GE(base::exp(-708.39), std::numeric_limits<double>::min());
  EXPECT_TRUE(std::isnan(base::exp(std::numeric_limits<double>::quiet_NaN())));
}

// No normal result is ever lost and no subnormal one ever made, at the very edge.
TEST(Exp, FlushesExactlyBelowTheSmallestNormal) {
  for (float x = -87.33650f; x > -87.33660f; x = std::nextafter(x, -infinity)) {
    const float value = base::exp(x);
    EXPECT_TRUE(value == 0.0f || value >= std::numeric_limits<float>::min()) << x;
  }
  for (double x = -708.3964185322632; x > -708.396418532266; x = std::nextafter(x, -infinity_d)) {
    const double value = base::exp(x);
    EXPECT_TRUE(value == 0.0 || value >= std::numeric_limits<double>::min()) << x;
  }
}

TEST(Log, EndsAreThoseOfTheHeader) {
  EXPECT_EQ(base::log(1.0f), 0.0f);
  EXPECT_EQ(base::log(0.0f), -infinity);
  EXPECT_EQ(base::log(infinity), infinity);
  EXPECT_TRUE(std::isnan(base::log(-1.0f)));
  EXPECT_TRUE(std::isnan(base::log(std::numeric_limits<float>::quiet_NaN())));
  EXPECT_EQ(base::log(1.0), 0.0);
  EXPECT_EQ(base::log(0.0), -infinity_d);
  EXPECT_EQ(base::log(infinity_d), infinity_d);
  EXPECT_TRUE(std::isnan(base::log(-1.0)));
  EXPECT_TRUE(std::isnan(base::log(std::numeric_limits<double>::quiet_NaN())));
}

// The bits are part of what a seed means: stored, because there is no second way to compute them.
TEST(Exp, BitsDoNotChange) {
  std::uint64_t digest = 0;
  base::Stream random(3, base::Purpose::tiling);
  for (int i = 0; i < 100'000; ++i) {
    const double x = 80 * (2 * random.next_double() - 1), y = 100 * random.next_double();
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(base::exp(x)) ^ std::bit_cast<std::uint64_t>(base::log(y)) ^
                               (std::uint64_t{std::bit_cast<std::uint32_t>(base::exp(static_cast<float>(x)))} << 16) ^
                               (std::uint64_t{std::bit_cast<std::uint32_t>(base::log(static_cast<float>(y)))} << 32);
    digest = (digest ^ bits) * 0x9E3779B97F4A7C15u;
    digest ^= digest >> 29;
  }
  EXPECT_EQ(digest, 3372895752123187444u);
}

}  // namespace
}  // namespace silvasim
