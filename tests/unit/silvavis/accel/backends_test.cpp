// The nested trees see what Embree sees.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "made_forest.h"
#include "silvasim/base/random.h"
#include "silvavis/accel/embree.h"
#include "silvavis/accel/nested.h"

namespace silvavis::testing {

namespace {

using accel::Hit;
using accel::Ray;
using accel::Surface;

// Rays from around and within the forest, in all directions that meet it.
std::vector<Ray> rays_over(const scene::Scene& scene, int count, std::uint64_t seed) {
  silvasim::base::Stream random(seed, silvasim::base::Purpose::rotation, 99);
  const auto between = [&](double a, double b) { return a + (b - a) * random.next_double(); };
  std::vector<Ray> rays(static_cast<std::size_t>(count));
  for (Ray& ray : rays) {
    const double far = random.next_below(3) == 0 ? 3000 : 60;
    ray.origin = {between(scene.extent.west - far, scene.extent.east + far),
                  between(scene.extent.south - far, scene.extent.north + far),
                  between(350, 400 + far) - (scene.ground.heights_m[0] == 0 ? 300 : 0)};
    V3d target(between(scene.extent.west, scene.extent.east), between(scene.extent.south, scene.extent.north), 0);
    target.z = scene::ground_at(scene.ground, target.x, target.y).height_m + between(-5, 15);
    const V3d d = (target - ray.origin).normalized();
    ray.direction = V3(static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)).normalized();
  }
  return rays;
}

struct Difference {
  int plants = 0;  // other plant or surface
  int depths = 0;  // same surface, another depth
  int hits = 0;
};

// The land is a sheet without underside: only Embree sees it from below, where a ray comes in beneath its rim.
bool from_below(const scene::Scene& scene, const Ray& ray, const Hit& hit) {
  if (hit.surface != Surface::ground) return false;
  const V3d before = ray.origin + V3d(ray.direction) * (hit.distance - 0.1);
  return before.z < scene::ground_at(scene.ground, before.x, before.y).height_m;
}

// Within a centimetre of the land's rim, where one of the two may see the sky.
bool past_the_rim(const scene::Scene& scene, const Ray& ray, const Hit& hit) {
  if (hit.surface != Surface::ground) return false;
  const V3d at = ray.origin + V3d(ray.direction) * hit.distance;
  const scene::Ground& g = scene.ground;
  return std::min({at.x - g.west, g.east() - at.x, at.y - g.south, g.north() - at.y}) < 0.01;
}

// `b` is Embree's.
Difference difference(const scene::Scene& scene, std::span<const Ray> rays, std::span<const Hit> a,
                      std::span<const Hit> b, double tolerance_m) {
  Difference d;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (from_below(scene, rays[i], b[i]) || past_the_rim(scene, rays[i], a[i]) || past_the_rim(scene, rays[i], b[i]))
      continue;
    d.hits += a[i].surface == Surface::plant ? 1 : 0;
    const bool same = a[i].surface == b[i].surface &&
                      (a[i].surface != Surface::plant ||
                       (a[i].layer == b[i].layer && a[i].column == b[i].column && a[i].row == b[i].row &&
                        a[i].site_slot == b[i].site_slot && a[i].species == b[i].species && a[i].model == b[i].model));
    if (!same) {
      ++d.plants;
    } else if (a[i].surface != Surface::none &&
               std::abs(a[i].distance - b[i].distance) > (a[i].surface == Surface::ground ? 0.05 : tolerance_m)) {
      ++d.depths;
    }
  }
  return d;
}

std::vector<Hit> nearest(const accel::Tracer& tracer, std::span<const Ray> rays) {
  std::vector<Hit> hits(rays.size());
  tracer.nearest(rays, hits);
  return hits;
}

}  // namespace

TEST(Backends, SeeTheSamePlantInEveryPixel) {
  for (const double hills : {0.0, 40.0}) {
    MadeForest made;
    made.hills_m = hills;
    const scene::Scene scene = made_forest(made);
    ASSERT_GT(scene.plants, 500u);
    const auto rays = rays_over(scene, 400000, 7);
    const auto nested = nearest(*accel::make_nested(scene), rays);
    const auto exact = nearest(*accel::make_embree(scene, accel::Flat::exact), rays);
    const Difference d = difference(scene, rays, nested, exact, 1e-3);
    EXPECT_GT(d.hits, 100000);
    // Both decide alike but for triangles' edges, which are many here: a picture's pixels differ less (tests/unit/silvavis/render).
    EXPECT_LE(d.plants, 16) << "hills " << hills;
    EXPECT_LE(d.depths, 16) << "hills " << hills;
  }
}

TEST(Backends, PlainInstancesDifferOnlyByTheirRounding) {
  const scene::Scene scene = made_forest({});
  const auto rays = rays_over(scene, 400000, 8);
  const auto nested = nearest(*accel::make_nested(scene), rays);
  const auto flat = nearest(*accel::make_embree(scene), rays);
  const Difference d = difference(scene, rays, nested, flat, 0.05);
  EXPECT_LE(d.plants, 400);
  EXPECT_LE(d.depths, 400);
  RecordProperty("other_plants", d.plants);
  RecordProperty("other_depths", d.depths);
}

TEST(Backends, OccludedIsWhetherThereIsAHit) {
  const scene::Scene scene = made_forest({});
  auto rays = rays_over(scene, 50000, 9);
  for (std::size_t i = 0; i < rays.size(); i += 2) rays[i].most = 80;
  for (std::size_t i = 0; i < rays.size(); i += 3) rays[i].least = 50;
  const auto tracer = accel::make_nested(scene);
  const auto hits = nearest(*tracer, rays);
  std::vector<std::uint8_t> answers(rays.size());
  tracer->occluded(rays, answers);
  int differ = 0, yes = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    differ += (hits[i].surface != Surface::none) != (answers[i] != 0);
    yes += answers[i];
    if (hits[i].surface != Surface::none) {
      EXPECT_GE(hits[i].distance, rays[i].least);
      EXPECT_LE(hits[i].distance, rays[i].most);
    }
  }
  EXPECT_EQ(differ, 0);
  EXPECT_GT(yes, 5000);
  EXPECT_LT(yes, 45000);
}

// Neither a direction along an axis nor a ray that begins within a crown may be special.
TEST(Backends, AgreeOnAxesAndFromWithin) {
  const scene::Scene scene = made_forest({});
  std::vector<Ray> rays;
  silvasim::base::Stream random(3, silvasim::base::Purpose::rotation);
  for (int i = 0; i < 30000; ++i) {
    Ray ray;
    ray.origin = {scene.extent.west + scene.extent.width() * random.next_double(),
                  scene.extent.south + scene.extent.height() * random.next_double(), 280 + 80 * random.next_double()};
    const int axis = i % 3;
    ray.direction = V3(0, 0, 0);
    ray.direction[axis] = i % 2 == 0 ? 1.0f : -1.0f;
    // From below the ground a ray meets its underside in Embree only.
    if (ray.origin.z < scene::ground_at(scene.ground, ray.origin.x, ray.origin.y).height_m + 0.1) continue;
    rays.push_back(ray);
  }
  const auto nested = nearest(*accel::make_nested(scene), rays);
  const auto exact = nearest(*accel::make_embree(scene, accel::Flat::exact), rays);
  const Difference d = difference(scene, rays, nested, exact, 1e-3);
  EXPECT_GT(d.hits, 3000);
  EXPECT_LE(d.plants, 1);
  EXPECT_LE(d.depths, 2);
}

}  // namespace silvavis::testing
