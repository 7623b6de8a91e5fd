// Rays to the sky: drawn as their density says, right on the mean, and without sparks under a low sun.
#include "silvavis/shade/sky_rays.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "silvasim/base/random.h"

namespace silvavis::shade {
namespace {

using silvasim::base::Stream;

Sky sky_under(float elevation_deg) {
  SkyOptions options;
  const float h = elevation_deg * pi / 180;
  options.sun_direction = {0.6f * std::cos(h), 0.8f * std::cos(h), std::sin(h)};
  return Sky(options);
}

V3 anywhere(Stream& stream) {
  const float z = 2 * stream.next_float() - 1, turn = 2 * pi * stream.next_float(), level = std::sqrt(1 - z * z);
  return {std::cos(turn) * level, std::sin(turn) * level, z};
}

TEST(SkyRays, ComeAsOftenAsTheirDensitySays) {
  for (const float elevation : {-6.0f, 3.0f, 20.0f, 60.0f, 89.0f}) {
    const SkyRays rays(sky_under(elevation));
    Stream stream(4, silvasim::base::Purpose::selection);
    // Second way: how many of them fall into eight parts of the sky, and the density's integral over each.
    std::array<double, 8> drawn{}, expected{};
    const auto part = [](const V3& d) {
      return static_cast<std::size_t>((d.x > 0 ? 1 : 0) + (d.y > 0 ? 2 : 0) + (d.z > 0.3f ? 4 : 0));
    };
    constexpr int count = 200000;
    for (int i = 0; i < count; ++i) {
      const V3 d = rays.towards(stream.next_float(), stream.next_float());
      ASSERT_NEAR(d.length(), 1, 1e-4f);
      ASSERT_GE(d.z, 0);
      ASSERT_GT(rays.density(d), 0) << d;
      drawn[part(d)] += 1.0 / count;
    }
    // Dense at the horizon and the sun, as the density is: z = t^2, and half of the directions in a cap around the sun's azimuth.
    constexpr int side = 1000;
    for (int i = 0; i < side; ++i) {
      for (int k = 0; k < side; ++k) {
        const float t = (static_cast<float>(i) + 0.5f) / side, z = t * t, level = std::sqrt(1 - z * z);
        const float away = (static_cast<float>(k) + 0.5f) / side * 2 - 1, turn = pi * away * away * away;
        const V3 d((0.6f * std::cos(turn) - 0.8f * std::sin(turn)) * level,
                   (0.8f * std::cos(turn) + 0.6f * std::sin(turn)) * level, z);
        const double size =
            2.0 / side * static_cast<double>(t) * 2.0 / side * 3 * static_cast<double>(pi * away * away);
        expected[part(d)] += static_cast<double>(rays.density(d)) * size;
      }
    }
    for (std::size_t i = 0; i < drawn.size(); ++i) EXPECT_NEAR(drawn[i], expected[i], 0.006) << elevation << " " << i;
  }
}

// The light on a surface, as the sampler asks for it; and its second moment, by even directions and by the sampler's.
TEST(SkyRays, AreRightOnTheMeanAndRareSparksAreGone) {
  for (const float elevation : {-3.0f, 3.0f, 10.0f, 60.0f}) {
    const Sky sky = sky_under(elevation);
    const SkyRays rays(sky);
    Stream stream(9, silvasim::base::Purpose::selection);
    for (int surface = 0; surface < 4; ++surface) {
      const V3 normal = surface == 0 ? V3(0, 0, 1) : surface == 1 ? V3(0.6f, 0.8f, 0) : anywhere(stream);
      constexpr int count = 400000;
      double even = 0, drawn = 0, most_even = 0, most_drawn = 0;
      for (int i = 0; i < count; ++i) {
        V3 d = anywhere(stream);
        if (d.z < 0) d.z = -d.z;
        const float cosine = std::max(0.0f, normal.dot(d));
        even += static_cast<double>(luminance(sky.radiance(d)) * cosine * 2 * pi) / count;
        if (cosine > 0) most_even = std::max(most_even, static_cast<double>(luminance(sky.radiance(d)) * pi));
        // The cosine's own directions, or the light's.
        const float u = stream.next_float();
        V3 asked = anywhere(stream);
        asked = u < rays.share() ? rays.towards(stream.next_float(), stream.next_float())
                                 : (asked * 0.9999f + normal).normalized();
        const float facing = normal.dot(asked);
        if (facing <= 0 || asked.z < 0) continue;
        const float density = (1 - rays.share()) * facing / pi + rays.share() * rays.density(asked);
        const double value = static_cast<double>(luminance(sky.radiance(asked)) * facing / density);
        drawn += value / count;
        most_drawn = std::max(most_drawn, value);
      }
      EXPECT_NEAR(drawn, even, 0.02 * even) << elevation << " " << normal;
      if (elevation > 0 && elevation < 15 && normal.dot(sky.sun_direction()) > 0.2f) {
        EXPECT_LT(most_drawn, 0.5 * most_even) << elevation << " " << normal;
      }
    }
  }
}

}  // namespace
}  // namespace silvavis::shade
