// Rays that are walked together meet to the last bit what each meets alone.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "../accel/made_forest.h"
#include "grown_wood.h"
#include "silvasim/base/random.h"
#include "silvavis/accel/nested.h"
#include "silvavis/shade/camera.h"

namespace silvavis::testing {

namespace {

using accel::Hit;
using accel::Ray;

bool same(const Hit& a, const Hit& b) {
  return std::memcmp(&a.distance, &b.distance, sizeof a.distance) == 0 && a.surface == b.surface &&
         a.layer == b.layer && a.species == b.species && a.column == b.column && a.row == b.row &&
         a.site_slot == b.site_slot && a.model == b.model && a.level == b.level && a.slot == b.slot &&
         std::memcmp(&a.u, &b.u, sizeof a.u) == 0 && std::memcmp(&a.v, &b.v, sizeof a.v) == 0;
}

// Squares of 4 x 4 pixels one after another, as wide as `lod` says.
std::vector<Ray> picture(const shade::Camera& camera, bool lod) {
  const shade::Lens lens = shade::lens_of(camera);
  std::vector<Ray> rays;
  for (int top = 0; top < camera.height; top += 4) {
    for (int left = 0; left < camera.width; left += 4) {
      for (int k = 0; k < 16; ++k) {
        const shade::CameraRay through = shade::ray_through(lens, left + k % 4 + 0.5, top + k / 4 + 0.5);
        Ray ray;
        ray.origin = through.origin;
        ray.direction = through.direction;
        if (lod) ray.spread = static_cast<float>(lens.footprint_rad);
        rays.push_back(ray);
      }
    }
  }
  return rays;
}

struct Counts {
  int rays = 0, plants = 0, other_hits = 0, shaded = 0, other_shadows = 0;
};

Counts compared(const scene::Scene& scene, std::vector<Ray> rays) {
  const auto tracer = accel::make_nested(scene);
  Counts counts;
  std::vector<Hit> together(rays.size());
  tracer->nearest(rays, together);
  std::vector<Ray> sunward;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Hit alone;
    tracer->nearest(std::span(&rays[i], 1), std::span(&alone, 1));
    ++counts.rays;
    counts.plants += alone.surface == accel::Surface::plant ? 1 : 0;
    counts.other_hits += same(alone, together[i]) ? 0 : 1;
    if (alone.surface == accel::Surface::none) continue;
    Ray ray;
    ray.origin = rays[i].origin + V3d(rays[i].direction) * alone.distance;
    ray.direction = V3(0.4f, -0.5f, 0.6f).normalized();
    ray.least = 0.01;
    ray.width_m = rays[i].spread * static_cast<float>(alone.distance);
    sunward.push_back(ray);
  }
  std::vector<std::uint8_t> shaded(sunward.size());
  tracer->occluded(sunward, shaded);
  for (std::size_t i = 0; i < sunward.size(); ++i) {
    std::uint8_t alone = 0;
    tracer->occluded(std::span(&sunward[i], 1), std::span(&alone, 1));
    counts.shaded += alone;
    counts.other_shadows += alone == shaded[i] ? 0 : 1;
  }
  return counts;
}

// From among the crowns, from above them and from afar.
void compare_views(const scene::Scene& scene, bool lod, int least_plants) {
  for (const double away_m : {0.0, 70.0, 400.0, 3000.0}) {
    SCOPED_TRACE(away_m);
    const double x = scene.extent.west + scene.extent.width() / 2, y = scene.extent.south + scene.extent.height() / 2;
    const double ground = scene::ground_at(scene.ground, x, y).height_m;
    shade::Camera camera;
    camera.width = 240;
    camera.height = 160;
    camera.fov_deg = away_m > 1000 ? 8 : 50;
    camera.eye = {x - away_m, y - 0.6 * away_m, ground + 7 + 0.5 * away_m};
    camera.look_at = {x + 20, y + 13, ground + 4};
    const Counts counts = compared(scene, picture(camera, lod));
    EXPECT_GT(counts.plants, least_plants);
    EXPECT_GT(counts.shaded, counts.rays / 50);
    EXPECT_EQ(counts.other_hits, 0);
    EXPECT_EQ(counts.other_shadows, 0);
  }
}

}  // namespace

TEST(Packets, MeetWhatSingleRaysMeetInTwoLayers) {
  MadeForest made;
  compare_views(made_forest(made), false, 3000);
  made.hills_m = 0;
  made.west = -150;
  made.south = -130;
  compare_views(made_forest(made), false, 3000);
}

TEST(Packets, MeetWhatSingleRaysMeetInAllLevels) { compare_views(grown_wood(6, 12000), true, 3000); }

// Squares whose rays part at an axis, go straight down, begin apart or end somewhere.
TEST(Packets, MeetWhatSingleRaysMeetWhereverTheyGo) {
  const scene::Scene scene = made_forest({});
  silvasim::base::Stream random(11, silvasim::base::Purpose::rotation);
  const auto between = [&](double a, double b) { return a + (b - a) * random.next_double(); };
  std::vector<Ray> rays;
  for (int group = 0; group < 4000; ++group) {
    const V3d origin(between(scene.extent.west, scene.extent.east), between(scene.extent.south, scene.extent.north),
                     between(285, 360));
    V3 direction(static_cast<float>(between(-1, 1)), static_cast<float>(between(-1, 1)),
                 static_cast<float>(between(-0.5, 0.2)));
    if (group % 5 == 0) direction[group % 2] = 0;
    if (group % 11 == 0) direction = {0, 0, -1};
    const double wide = group % 3 == 0 ? 0 : 0.003, apart = group % 4 == 0 ? 0.3 : 0;
    for (int k = 0; k < 16; ++k) {
      Ray ray;
      ray.origin = origin + V3d(between(-apart, apart), between(-apart, apart), between(-apart, apart));
      ray.direction = (direction.normalized() + V3(static_cast<float>(between(-wide, wide)),
                                                   static_cast<float>(between(-wide, wide)),
                                                   static_cast<float>(between(-wide, wide))))
                          .normalized();
      if (group % 7 == 0) ray.most = between(1, 60);
      if (group % 6 == 0) ray.least = between(0, 30);
      rays.push_back(ray);
    }
  }
  const Counts counts = compared(scene, rays);
  EXPECT_GT(counts.plants, 10000);
  EXPECT_GT(counts.shaded, 1000);
  EXPECT_EQ(counts.other_hits, 0);
  EXPECT_EQ(counts.other_shadows, 0);
}

}  // namespace silvavis::testing
