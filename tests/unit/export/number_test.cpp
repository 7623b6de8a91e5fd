#include "silvasim/export/number.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "silvasim/base/random.h"

namespace silvasim::exports {
namespace {

std::string fixed(double value, int decimals, bool bare = false) {
  std::string text = "x";
  append_fixed(text, value, decimals, bare);
  return text.substr(1);
}

TEST(Number, reads_as_expected) {
  EXPECT_EQ(fixed(0, 3), "0.000");
  EXPECT_EQ(fixed(-0.0004, 3), "0.000");
  EXPECT_EQ(fixed(-0.0005, 3), "-0.001");
  EXPECT_EQ(fixed(12.3456, 2), "12.35");
  EXPECT_EQ(fixed(12.3, 0), "12");
  EXPECT_EQ(fixed(5190000, 3), "5190000.000");
  EXPECT_EQ(fixed(12.5, 2, true), "12.5");
  EXPECT_EQ(fixed(12, 2, true), "12");
  EXPECT_EQ(fixed(0.05, 2, true), "0.05");
  EXPECT_EQ(fixed(-121.67714272, 8), "-121.67714272");
  EXPECT_EQ(fixed(std::nan(""), 2), "");
  EXPECT_EQ(fixed(1e18, 3), "1000000000000000000.000");
}

TEST(Number, differs_from_the_value_by_half_a_digit_at_most) {
  constexpr std::uint64_t seed = 20;
  base::Stream random(seed, base::Purpose::selection);
  for (int i = 0; i < 200000; ++i) {
    const double size = std::pow(10.0, static_cast<double>(random.next_below(12)) - 4);
    const double value = (random.next_double() - 0.5) * size;
    const int decimals = static_cast<int>(random.next_below(9));
    for (const bool bare : {false, true}) {
      const std::string text = fixed(value, decimals, bare);
      const double back = std::stod(text);
      ASSERT_LE(std::fabs(back - value), 0.5 * std::pow(10.0, -decimals) * (1 + 1e-9) + std::fabs(value) * 1e-15)
          << text << " seed " << seed << " round " << i;
      const std::size_t point = text.find('.');
      const std::size_t places = point == std::string::npos ? 0 : text.size() - point - 1;
      if (bare) {
        ASSERT_TRUE(places == 0 || (places <= static_cast<std::size_t>(decimals) && text.back() != '0')) << text;
      } else {
        ASSERT_EQ(places, static_cast<std::size_t>(decimals)) << text;
      }
    }
  }
}

}  // namespace
}  // namespace silvasim::exports
