// Haze against sums along the ray, the spectral integral, and the sky that it fades into.
#include "silvavis/shade/haze.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "silvasim/base/random.h"
#include "silvavis/shade/scattering.h"

namespace silvavis::shade {
namespace {

constexpr double degree = 0.017453292519943295;

V3 direction(double azimuth_deg, double elevation_deg) {
  const double a = azimuth_deg * degree, e = elevation_deg * degree;
  return V3(V3d(std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e)));
}

Sky sky_of(double sun_deg, double visibility_km = 60) {
  SkyOptions options;
  options.sun_direction = direction(180, sun_deg);
  options.visibility_km = visibility_km;
  return Sky(options);
}

TEST(Haze, NothingBetweenChangesNothing) {
  const Haze haze(sky_of(40));
  const Rgb colour(0.1f, 0.2f, 0.3f);
  EXPECT_EQ(haze.apply(colour, 0, 500, direction(20, -10)), colour);
  const Rgb near = haze.apply(colour, 1, 500, direction(20, -10));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(near[c], colour[c], 1e-4f);
}

TEST(Haze, AtTheDistanceOfSightBlackThingsAreGone) {
  for (const double visibility : {10.0, 60.0}) {
    const Haze haze(sky_of(40, visibility));
    const Haze::Veil veil = haze.veil(static_cast<float>(visibility * 1000), 0, direction(90, 0));
    EXPECT_NEAR(veil.transmittance.y, 0.02f, 0.006f);
    EXPECT_GT(veil.transmittance.x, veil.transmittance.y);  // red comes farther
    EXPECT_LT(veil.transmittance.z, veil.transmittance.y);
  }
}

TEST(Haze, TransmittanceIsThatOfASumAlongTheRay) {
  const Haze haze(sky_of(40));
  // The coefficients at the ground, each from a ray on which the other medium has gone.
  const Haze::Veil level = haze.veil(1000, 0, V3(0, 1, 0)), high = haze.veil(1000, 20000, V3(0, 1, 0));
  silvasim::base::Stream stream(3, silvasim::base::Purpose::selection);
  for (int c = 0; c < 3; ++c) {
    const double both = -std::log(static_cast<double>(level.transmittance[c])) / 1000;
    const double thin = -std::log(static_cast<double>(high.transmittance[c])) / 1000;
    const double rayleigh =
        (thin - both * std::exp(-20000 / 1200.0)) / (std::exp(-20000 / 8400.0) - std::exp(-20000 / 1200.0));
    const double mie = both - rayleigh;
    for (int i = 0; i < 200; ++i) {
      const double eye = 4000 * stream.next_double(), elevation = i < 20 ? 1e-3 * i : 40 * stream.next_double() - 20;
      const double sine = std::sin(elevation * degree);
      double distance = 50 + 40000 * stream.next_double();
      if (sine < 0) distance = std::min(distance, -eye / sine);
      double depth = 0;
      constexpr int steps = 4000;
      for (int k = 0; k < steps; ++k) {
        const double h = eye + sine * distance * (k + 0.5) / steps;
        depth += (rayleigh * std::exp(-h / 8400) + mie * std::exp(-h / 1200)) * distance / steps;
      }
      const Haze::Veil veil =
          haze.veil(static_cast<float>(distance), static_cast<float>(eye), direction(30, elevation));
      EXPECT_NEAR(static_cast<double>(veil.transmittance[c]), std::exp(-depth), 2e-3) << eye << " " << elevation;
    }
  }
}

TEST(Haze, DepthInGreenLightIsThatOfTheVeil) {
  const Haze haze(sky_of(40));
  for (const double height : {10.0, 900.0, 6000.0}) {
    const double distance = 3 * height + 500, sine = -height / distance;
    const Haze::Veil veil =
        haze.veil(static_cast<float>(distance), static_cast<float>(height), direction(20, std::asin(sine) / degree));
    EXPECT_NEAR(std::exp(-haze_depth(60, height, 0, distance)), static_cast<double>(veil.transmittance.y), 0.012)
        << height;
  }
}

TEST(Haze, AShareOfTheAirTakesAShareOfTheDepthAndFarAwayAll) {
  const Sky sky = sky_of(40);
  const Haze whole(sky), part(sky, {0.25f, 5000}), none(sky, {0, 5000});
  const V3 d = direction(50, -4);
  const Rgb colour(0.1f, 0.2f, 0.3f);
  EXPECT_EQ(none.apply(colour, 4000, 800, d), colour);
  for (int c = 0; c < 3; ++c) {
    const float all = whole.veil(4000, 800, d).transmittance[c], some = part.veil(4000, 800, d).transmittance[c];
    EXPECT_NEAR(std::log(some), 0.25f * std::log(all), 1e-5f);
    float before = 1;
    for (float distance = 500; distance < 30000; distance += 250) {
      const float now = part.veil(distance, 2200, d).transmittance[c];
      EXPECT_LE(now, before + 1e-6f);  // what is farther is never clearer
      before = now;
    }
    EXPECT_EQ(part.veil(15001, 2200, d).transmittance[c], whole.veil(15001, 2200, d).transmittance[c]);
  }
}

TEST(Haze, TwoStretchesOfAWayAreTheWay) {
  const Haze haze(sky_of(30));
  for (const double elevation : {-8.0, -0.1, 0.0, 5.0}) {
    const V3 d = direction(70, elevation);
    const float rise = d.z * 7000;
    const Rgb whole = haze.veil(20000, 3000, d).transmittance;
    const Rgb parts = haze.veil(7000, 3000, d).transmittance * haze.veil(13000, 3000 + rise, d).transmittance;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(whole[c], parts[c], 1e-4f) << elevation;
  }
}

TEST(Haze, AgreesWithTheIntegralOverTheRoundSpectralAtmosphere) {
  struct Case {
    double visibility_km, sun_deg, most_error;
  };
  for (const Case& c :
       {Case{60, 60, 0.05}, Case{60, 30, 0.07}, Case{60, 10, 0.13}, Case{150, 30, 0.05}, Case{20, 45, 0.1}}) {
    const Sky sky = sky_of(c.sun_deg, c.visibility_km);
    const Haze haze(sky);
    const double sun_sine = static_cast<double>(sky.sun_direction().z);
    const MultipleScattering multiple(sky.air(), sun_sine, spectrum_of(sky.options().ground_albedo));
    const Rgb sun = rgb_of(sky.air().sun());
    for (const double eye : {2.0, 500.0, 3000.0}) {
      for (const double elevation : {0.0, -3.0, -10.0, -35.0}) {
        for (const double azimuth : {0.0, 90.0, 180.0}) {
          for (const double distance : {1000.0, 5000.0, 20000.0, 40000.0}) {
            const V3 d = direction(azimuth, elevation);
            if (eye + static_cast<double>(d.z) * distance < 0) continue;
            const double cosine = static_cast<double>(d.dot(sky.sun_direction()));
            const SkyLight light =
                scattered(sky.air(), multiple, {eye, static_cast<double>(d.z), cosine}, sun_sine, distance);
            Spectrum left, added;
            for (std::size_t k = 0; k < wavelengths; ++k) {
              left[k] = light.transmittance[k] * sky.air().sun()[k];
              added[k] =
                  sky.air().sun()[k] * (light.rayleigh[k] * rayleigh_phase(static_cast<float>(cosine)) +
                                        light.mie[k] * mie_phase(static_cast<float>(cosine)) + light.multiple[k]);
            }
            const Haze::Veil veil = haze.veil(static_cast<float>(distance), static_cast<float>(eye), d);
            const Rgb truth = rgb_of(left) / sun;
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(veil.transmittance[k], truth[k], 0.015f);
            const double green = static_cast<double>(rgb_of(added).y) * 683 / Sky::cd_m2_per_unit * 1.01971;
            EXPECT_NEAR(static_cast<double>(veil.in_scattered.y), green, c.most_error * green)
                << c.sun_deg << " " << c.visibility_km << " " << eye << " " << elevation << " " << azimuth << " "
                << distance;
          }
        }
      }
    }
  }
}

TEST(Haze, WhatIsFarEnoughFadesIntoTheHorizon) {
  // The haze lies on a flat earth; on the round one the horizon of an eye at 2 m is 0.0454 degrees below the level.
  for (const double h : {60.0, 20.0, 3.0, -3.0}) {
    const Sky sky = sky_of(h);
    const Haze haze(sky);
    for (double azimuth = 0; azimuth < 360; azimuth += 30) {
      const Rgb far = haze.apply(Rgb(0, 0, 0), 900e3f, 2, direction(azimuth, 0));
      const Rgb horizon = sky.radiance(direction(azimuth, -0.0454));
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(far[c], horizon[c], 0.05f * horizon[c] + 0.005f * horizon.x + 2e-5f) << h << " " << azimuth;
    }
  }
}

TEST(Haze, GroundOfTheSkyLooksAsFarAwayAsGroundUnderHaze) {
  // Below the horizon the sky shows the land around, by another way: with the same colour and distance they meet.
  SkyOptions options;
  options.sun_direction = direction(180, 50);
  options.eye_height_m = 800;
  const Sky sky(options);
  const Haze haze(sky);
  const Rgb light = sky.sun_irradiance() * sky.sun_direction().z + sky.sky_irradiance();
  for (const double elevation : {-4.0, -8.0, -20.0, -60.0}) {
    const V3 d = direction(60, elevation);
    const Rgb hazed = haze.apply(options.ground_albedo * light / pi, -800 / d.z, 800, d), seen = sky.radiance(d);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(hazed[c], seen[c], 0.12f * seen[c]) << elevation << " " << c;
  }
}

TEST(Haze, MoreDistanceIsMoreVeil) {
  const Haze haze(sky_of(15));
  Haze::Veil before = haze.veil(0, 200, direction(100, 0.5));
  for (float distance = 10; distance < 2e5f; distance *= 1.3f) {
    const Haze::Veil now = haze.veil(distance, 200, direction(100, 0.5));
    for (int c = 0; c < 3; ++c) {
      EXPECT_LE(now.transmittance[c], before.transmittance[c]);
      EXPECT_GE(now.in_scattered[c], before.in_scattered[c] * 0.99f);
    }
    before = now;
  }
}

TEST(Haze, IsFiniteWhateverIsAsked) {
  const float inf = std::numeric_limits<float>::infinity();
  for (const double sun : {90.0, 10.0, 0.0, -5.0, -40.0}) {
    const Haze haze(sky_of(sun));
    for (const float distance : {0.0f, 1e-3f, 1e4f, 1e9f, inf, -5.0f}) {
      for (const float eye : {-1e6f, -100.0f, 0.0f, 1e4f, 1e6f}) {
        for (const V3& d : {V3(0, 0, 1), V3(0, 0, -1), V3(0, 1, 0), direction(180, 10), direction(33, -1e-4)}) {
          const Rgb seen = haze.apply(Rgb(0.1f, 0.1f, 0.1f), distance, eye, d);
          for (int c = 0; c < 3; ++c)
            ASSERT_TRUE(std::isfinite(seen[c]) && seen[c] >= 0) << distance << " " << eye << d;
        }
      }
    }
  }
}

}  // namespace
}  // namespace silvavis::shade
