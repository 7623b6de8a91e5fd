// What the ground consists of: as bright on the mean whatever it is and however wide the ray, and never finer than that.
#include "silvavis/shade/grain.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "silvasim/base/random.h"

namespace silvavis::shade {
namespace {

using silvasim::base::Stream;

constexpr std::array<GroundParts, 5> grounds = {
    {{1, 0, 0, 0, 0}, {0, 1, 0, 0, 0}, {0, 0, 1, 0, 0}, {0, 0, 0, 1, 0}, {0, 0, 0, 0, 1}}};

TEST(Grain, IsOneOnTheMeanAndEvensOutWhereRaysAreWide) {
  for (const GroundParts& parts : grounds) {
    double last = 1e9;
    for (const double width : {0.0, 0.03, 0.3, 3.0, 30.0}) {
      Stream stream(5, silvasim::base::Purpose::selection);
      constexpr int count = 20000;
      double sum = 0, squares = 0;
      for (int i = 0; i < count; ++i) {
        const auto light = static_cast<double>(
            luminance(grain(parts, 900 * stream.next_double() - 450, 900 * stream.next_double() - 450, width)));
        EXPECT_GT(light, 0);
        sum += light / count;
        squares += light * light / count;
      }
      EXPECT_NEAR(sum, 1, 0.02) << width;
      const double variance = squares - sum * sum;
      EXPECT_LE(variance, last + 1e-9) << width;
      if (width == 0) {
        EXPECT_GT(variance, 0.01);
      }
      if (width == 30) {
        EXPECT_LT(variance, 1e-9);
      }
      last = variance;
    }
  }
}

// Second way: the mean of what a narrow ray sees over the wide ray's width is what the wide ray sees, but for what cells of a grid shift.
TEST(Grain, OfAWideRayIsTheMeanOfNarrowOnes) {
  Stream stream(6, silvasim::base::Purpose::selection);
  constexpr double width = 0.6;
  double apart = 0, spread = 0;
  constexpr int count = 300, side = 12;
  for (int i = 0; i < count; ++i) {
    const double x = 300 * stream.next_double(), y = 300 * stream.next_double();
    double mean = 0;
    for (int k = 0; k < side * side; ++k) {
      mean += static_cast<double>(luminance(grain({}, x + width * ((k % side + 0.5) / side - 0.5),
                                                  y + width * ((k / side + 0.5) / side - 0.5), 0))) /
              (side * side);
    }
    const auto wide = static_cast<double>(luminance(grain({}, x, y, width)));
    apart += std::abs(wide - mean) / count;
    spread += std::abs(static_cast<double>(luminance(grain({}, x, y, 0))) - mean) / count;
  }
  EXPECT_LT(apart, 0.5 * spread);
}

TEST(Grain, FlakesAreOfAllTonesAndMeetAtEdges) {
  Stream stream(7, silvasim::base::Purpose::selection);
  double tone = 0, inside = 0;
  constexpr int count = 50000;
  for (int i = 0; i < count; ++i) {
    const Flake one = flake(1000 * stream.next_double(), 1000 * stream.next_double(), 0.4);
    tone += static_cast<double>(one.tone) / count;
    inside += static_cast<double>(one.inside) / count;
    EXPECT_GE(one.inside, 0);
    EXPECT_LE(one.inside, 1);
  }
  EXPECT_NEAR(tone, 0.5, 0.01);
  EXPECT_NEAR(inside, 0.637, 0.01);
}

}  // namespace
}  // namespace silvavis::shade
