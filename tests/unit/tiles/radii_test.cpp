// Radii against closed forms by the C library's erf, computed another way than the room does.
#include "silvasim/tiles/radii.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace silvasim::tiles {
namespace {

using config::RadiusDistribution;

double normal_below(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

// Share of sites with a radius of at most r.
double share_below(const config::TileSettings& s, double r) {
  const double a = s.least_radius_m, b = s.most_radius_m;
  if (s.distribution == RadiusDistribution::uniform) return (r - a) / (b - a);
  const double mean = s.mean_radius_m > 0 ? s.mean_radius_m : (a + b) / 2;
  const double deviation = s.deviation_radius_m > 0 ? s.deviation_radius_m : (b - a) / 6;
  std::function<double(double)> below = [&](double x) { return normal_below((x - mean) / deviation); };
  if (s.distribution == RadiusDistribution::lognormal) {
    const double sigma = std::sqrt(std::log1p(deviation * deviation / mean / mean));
    const double mu = std::log(mean) - sigma * sigma / 2;
    below = [=](double x) { return normal_below((std::log(x) - mu) / sigma); };
  }
  return (below(r) - below(a)) / (below(b) - below(a));
}

std::vector<config::TileSettings> some_settings() {
  std::vector<config::TileSettings> all;
  for (const RadiusDistribution d :
       {RadiusDistribution::uniform, RadiusDistribution::normal, RadiusDistribution::lognormal}) {
    for (const auto& [least, most, mean, deviation] : {std::array{2.0, 8.0, 0.0, 0.0},
                                                       {2.0, 8.0, 3.0, 2.0},
                                                       {0.2, 0.9, 0.3, 0.05},
                                                       {5.0, 9.0, 9.0, 20.0},
                                                       {1.0, 100.0, 2.0, 1.5},
                                                       {4.0, 6.0, 5.0, 0.01}}) {
      config::TileSettings s;
      s.distribution = d;
      s.least_radius_m = least, s.most_radius_m = most;
      if (d != RadiusDistribution::uniform) s.mean_radius_m = mean, s.deviation_radius_m = deviation;
      all.push_back(s);
    }
  }
  return all;
}

TEST(Radii, QuantileIsTheInverseOfTheShare) {
  for (const auto& s : some_settings()) {
    SCOPED_TRACE(testing::Message() << static_cast<int>(s.distribution) << " " << s.least_radius_m << ".."
                                    << s.most_radius_m << " mean " << s.mean_radius_m << " +- "
                                    << s.deviation_radius_m);
    const Radii radii(s);
    float before = 0;
    for (int i = 0; i <= 1000; ++i) {
      const double u = i / 1000.0;
      const float r = radii.quantile(u);
      EXPECT_GE(r, before) << "not monotone at " << u;
      EXPECT_GE(static_cast<double>(r), s.least_radius_m);
      EXPECT_LE(static_cast<double>(r), s.most_radius_m);
      EXPECT_NEAR(share_below(s, static_cast<double>(r)), u, 2e-4);
      before = r;
    }
  }
}

TEST(Radii, MomentsAreThoseOfTheQuantile) {
  for (const auto& s : some_settings()) {
    const Radii radii(s);
    double first = 0, second = 0;
    constexpr int steps = 200'000;
    for (int i = 0; i < steps; ++i) {
      const double r = static_cast<double>(radii.quantile((i + 0.5) / steps));
      first += r / steps, second += r * r / steps;
    }
    EXPECT_NEAR(first / radii.mean_m(), 1, 1e-4);
    EXPECT_NEAR(second / radii.mean_square_m2(), 1, 3e-4);
    EXPECT_NEAR(radii.sites_per_m2(0.4) * 3.14159265358979 * second, 0.4, 3e-4);
  }
}

TEST(Radii, EqualRadiiAreEqual) {
  for (const auto d : {RadiusDistribution::uniform, RadiusDistribution::normal, RadiusDistribution::lognormal}) {
    config::TileSettings s;
    s.least_radius_m = s.most_radius_m = 0.1;  // no float
    s.distribution = d;
    const Radii radii(s);
    EXPECT_EQ(radii.quantile(0), radii.quantile(1));
    EXPECT_NEAR(radii.mean_m(), 0.1, 1e-12);
    EXPECT_NEAR(radii.deviation_m(), 0, 1e-9);
  }
}

}  // namespace
}  // namespace silvasim::tiles
