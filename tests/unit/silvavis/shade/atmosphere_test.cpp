// The air's numbers against published ones, and its tables against plain sums.
#include "silvavis/shade/atmosphere.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "silvasim/base/error.h"
#include "silvavis/shade/scattering.h"

namespace silvavis::shade {
namespace {

constexpr std::size_t at_450_nm = 3, at_550_nm = 8;

TEST(Atmosphere, SunlightAndColoursAreThePublishedOnes) {
  const Atmosphere air(60);
  // The luminous solar constant is 133 klux (Darula, Kittler and Gueymard 2005: 133.3).
  EXPECT_NEAR(683e-3 * static_cast<double>(luminance(rgb_of(air.sun()))), 133.3, 2);
  // Equal energy: Y is the integral of the eye's sensitivity, 106.86 nm, and x = y = 1/3 has this colour in sRGB.
  const Rgb equal = rgb_of(filled(1));
  EXPECT_NEAR(luminance(equal), 106.86f, 1);
  const Rgb ratio = equal / luminance(equal);
  EXPECT_NEAR(ratio.x, 1.205f, 0.02f);
  EXPECT_NEAR(ratio.y, 0.948f, 0.02f);
  EXPECT_NEAR(ratio.z, 0.909f, 0.02f);
}

TEST(Atmosphere, ExtinctionIsThePublishedOne) {
  const Atmosphere air(60);
  // Bodhaine et al. 1999: the whole column of air takes 0.0972 at 550 nm and 0.2195 at 450 nm.
  EXPECT_NEAR(static_cast<double>(air.rayleigh()[at_550_nm]) * Atmosphere::rayleigh_height_m, 0.0972, 0.001);
  EXPECT_NEAR(static_cast<double>(air.rayleigh()[at_450_nm]) * Atmosphere::rayleigh_height_m, 0.2195, 0.003);
  for (const double visibility_km : {5.0, 60.0, 200.0}) {
    const Atmosphere other(visibility_km);
    const double all = static_cast<double>(other.rayleigh()[at_550_nm] + other.mie()[at_550_nm]);
    EXPECT_NEAR(std::exp(-all * visibility_km * 1000), 0.02, 1e-4);
    for (std::size_t i = 0; i < wavelengths; ++i) EXPECT_GE(other.mie()[i], other.mie_scattered()[i]);
  }
  for (const double wrong : {0.0, 0.5, 400.0, std::nan("")}) EXPECT_THROW(Atmosphere{wrong}, silvasim::base::Error);
}

TEST(Atmosphere, PhaseFunctionsSpreadAllLightOnce) {
  double rayleigh = 0, mie = 0, forward = 0;
  constexpr int steps = 200000;
  for (int i = 0; i < steps; ++i) {
    const double c = (i + 0.5) / steps * 2 - 1, share = 4 * 3.14159265358979 / steps;
    rayleigh += share * static_cast<double>(rayleigh_phase(static_cast<float>(c)));
    mie += share * static_cast<double>(mie_phase(static_cast<float>(c)));
    forward += c * share * static_cast<double>(mie_phase(static_cast<float>(c)));
  }
  EXPECT_NEAR(rayleigh, 1, 1e-4);
  EXPECT_NEAR(mie, 1, 1e-3);
  EXPECT_GT(forward, 0.75);
  EXPECT_GT(mie_phase(1), 100 * mie_phase(-0.5f));
}

// The same columns by many small steps along the ray, without a table.
Columns summed(double height_m, double cosine) {
  const double r = Atmosphere::ground_radius_m + height_m, top = Atmosphere::ground_radius_m + 100e3;
  const double length = -r * cosine + std::sqrt(r * r * (cosine * cosine - 1) + top * top);
  constexpr int steps = 200000;
  double rayleigh = 0, mie = 0, ozone = 0;
  for (int i = 0; i < steps; ++i) {
    const double t = length * (i + 0.5) / steps;
    const double h = std::sqrt(r * r + t * t + 2 * r * t * cosine) - Atmosphere::ground_radius_m;
    rayleigh += std::exp(-h / 8400) * length / steps;
    mie += std::exp(-h / 1200) * length / steps;
    ozone += std::max(0.0, 1 - std::abs(h - 25e3) / 15e3) * length / steps;
  }
  return {static_cast<float>(rayleigh), static_cast<float>(mie), static_cast<float>(ozone)};
}

TEST(Atmosphere, ColumnsAreThoseOfAPlainSum) {
  const Atmosphere air(60);
  EXPECT_NEAR(air.to_top(0, 1).rayleigh, 8400, 5);
  EXPECT_NEAR(air.to_top(0, 1).mie, 1200, 3);
  EXPECT_NEAR(air.to_top(0, 1).ozone, 15000, 40);
  for (const double height : {0.0, 30.0, 700.0, 4000.0, 20000.0, 60000.0}) {
    for (const double cosine : {1.0, 0.5, 0.1, 0.02, 0.0}) {
      const Columns table = air.to_top(static_cast<float>(height), static_cast<float>(cosine));
      const Columns truth = summed(height, cosine);
      // Seen from high up the haze is thin, and a share of next to nothing tells nothing.
      EXPECT_NEAR(table.rayleigh, truth.rayleigh, 0.02f * truth.rayleigh + 20) << height << " " << cosine;
      EXPECT_NEAR(table.mie, truth.mie, 0.03f * truth.mie + 20) << height << " " << cosine;
      EXPECT_NEAR(table.ozone, truth.ozone, 0.02f * truth.ozone + 50) << height << " " << cosine;
    }
  }
  // Below the level, but past the earth.
  const double down = horizon_cosine(20000) + 0.01;
  const Columns past = air.to_top(20000, static_cast<float>(down)), truth = summed(20000, down);
  EXPECT_NEAR(past.rayleigh, truth.rayleigh, 0.04f * truth.rayleigh);
}

TEST(Atmosphere, TheSunSetsOverItsWholeWidth) {
  for (const float height : {2.0f, 3000.0f}) {
    const double horizon = std::asin(horizon_cosine(static_cast<double>(height)));
    const auto share = [&](double minutes) {
      return Atmosphere::share_of_sun(height, static_cast<float>(std::sin(horizon + minutes / 3437.75)));
    };
    EXPECT_EQ(share(17), 1);
    EXPECT_NEAR(share(0), 0.5f, 0.01f);
    EXPECT_EQ(share(-17), 0);
    float before = 0;
    for (double minutes = -17; minutes <= 17; minutes += 0.25) {
      EXPECT_GE(share(minutes), before - 1e-3f);
      before = share(minutes);
    }
  }
}

TEST(Scattering, SingleScatteringIsThatOfAPlaneLayer) {
  // Nearly pure air, seen steeply: there a flat layer has a closed form (Chandrasekhar 1960). Ozone above takes from
  // the sunlight first; the haze aloft, in the middle, takes from all light once.
  const Atmosphere air(300);
  const double sun = std::sin(0.9), view = std::sin(1.2);
  const MultipleScattering none(air, sun, filled(0));
  const SkyLight light = scattered(air, none, {0, view, 0.5}, sun, 1e9);
  for (std::size_t i = 1; i < wavelengths; ++i) {
    const double rayleigh = static_cast<double>(air.rayleigh()[i]) * 8400;
    const double depth = rayleigh + static_cast<double>(air.mie()[i]) * 1200;
    const double ozone = std::exp(-static_cast<double>(air.ozone()[i]) * 15000 / sun);
    const double aloft = std::exp(-static_cast<double>(air.aloft()[i] * air.to_top(0, 1).aloft) * 2 / (sun + view));
    const double truth =
        rayleigh / depth * ozone * aloft * sun / (sun - view) * (std::exp(-depth / sun) - std::exp(-depth / view));
    EXPECT_NEAR(static_cast<double>(light.rayleigh[i]), truth, 0.03 * truth) << i;
  }
}

TEST(Scattering, WhatIsTakenAndWhatIsLeftAreTheWhole) {
  const Atmosphere air(20);
  const MultipleScattering multiple(air, 0.5, filled(0.1f));
  for (const double sine : {0.9, 0.1, -0.1, -0.9}) {
    const SkyLight light = scattered(air, multiple, {500, sine, 0.3}, 0.5, 30000);
    for (std::size_t i = 0; i < 4; ++i) {  // hardly any ozone there
      EXPECT_NEAR(light.by_rayleigh[i] + light.by_mie[i] + light.transmittance[i], 1, 2e-3);
    }
  }
}

TEST(Scattering, RaysEndAtTheGroundOrTheTop) {
  bool ground = false;
  EXPECT_NEAR(length_in_air(1000, 1, ground), 99e3, 1e-3);
  EXPECT_FALSE(ground);
  EXPECT_NEAR(length_in_air(1000, -1, ground), 1000, 1e-3);
  EXPECT_TRUE(ground);
  EXPECT_NEAR(length_in_air(1000, horizon_cosine(1000) - 1e-9, ground), std::sqrt(2 * 6360e3 * 1000), 1000);
  EXPECT_TRUE(ground);
  length_in_air(1000, horizon_cosine(1000) + 1e-9, ground);
  EXPECT_FALSE(ground);
}

}  // namespace
}  // namespace silvavis::shade
