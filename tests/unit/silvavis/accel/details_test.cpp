// Ground detail is met where it stands: by trees, by Embree, and by asking every instance.
#include <gtest/gtest.h>

// As in silvavis/accel/nested.cpp: what its kernel is compiled for.
#define HWY_DISABLED_TARGETS (HWY_AVX3 | HWY_AVX3_DL | HWY_SSSE3)
#include <hwy/highway.h>
#include <hwy/targets.h>

#include <bit>
#include <map>
#include <tuple>

#include "made_ground.h"
#include "same_bits.h"
#include "silvavis/accel/embree.h"
#include "silvavis/accel/nested.h"
#include "silvavis/scene/detail_ray.h"

namespace silvavis::testing {

namespace {

using accel::Hit;
using accel::Ray;
using accel::Surface;

// To the details from near and far, within them, and along axes.
std::vector<Ray> rays_to(const scene::Scene& scene, std::size_t count, std::uint64_t seed) {
  silvasim::base::Stream random(seed, silvasim::base::Purpose::rotation, 17);
  const auto between = [&](double a, double b) { return a + (b - a) * random.next_double(); };
  std::vector<Ray> rays(count);
  for (std::size_t i = 0; i < count; ++i) {
    Ray& ray = rays[i];
    V3d target(between(-22, 32), between(-22, 22), 0);
    target.z = scene::ground_at(scene.ground, target.x, target.y).height_m + between(0, 0.8);
    const double far = i % 7 == 0 ? 3000 : i % 3 == 0 ? 30 : 1.5;
    ray.origin = target + V3d(between(-far, far), between(-far, far), between(0.02, 0.7) * far);
    ray.direction = V3((target - ray.origin).normalized()).normalized();
    if (i % 41 == 0) ray.direction = V3(0, 0, -1);
    if (i % 43 == 0) ray.direction = V3(1, 0, 0);
    if (i % 47 == 0) ray.direction = V3(0, -1, 0);
    // From below the land Embree sees its underside.
    if (ray.origin.z < scene::ground_at(scene.ground, ray.origin.x, ray.origin.y).height_m + 0.01)
      ray.origin.z = scene::ground_at(scene.ground, ray.origin.x, ray.origin.y).height_m + 0.02;
  }
  return rays;
}

std::vector<Hit> nearest(const accel::Tracer& tracer, std::span<const Ray> rays) {
  std::vector<Hit> hits(rays.size());
  tracer.nearest(rays, hits);
  return hits;
}

bool same_thing(const Hit& a, const Hit& b) {
  if (a.surface != b.surface) return false;
  return a.surface == Surface::none || a.surface == Surface::ground ||
         (a.layer == b.layer && a.column == b.column && a.row == b.row && a.site_slot == b.site_slot &&
          a.model == b.model);
}

struct Difference {
  int details = 0, things = 0, depths = 0;
};
// `b` may be Embree's, which alone sees the land's underside, where a ray comes in beneath its rim.
Difference difference(const scene::Scene& scene, std::span<const Ray> rays, std::span<const Hit> a,
                      std::span<const Hit> b, double tolerance_m) {
  Difference d;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (b[i].surface == Surface::ground) {
      const V3d before = rays[i].origin + V3d(rays[i].direction) * (b[i].distance - 0.1);
      if (before.z < scene::ground_at(scene.ground, before.x, before.y).height_m) continue;
    }
    d.details += a[i].surface == Surface::detail ? 1 : 0;
    if (!same_thing(a[i], b[i])) {
      ++d.things;
    } else if (a[i].surface == Surface::detail && std::abs(a[i].distance - b[i].distance) > tolerance_m) {
      ++d.depths;
    }
  }
  return d;
}

class Only {
 public:
  explicit Only(std::int64_t target) { choose(target); }
  Only(const Only&) = delete;
  Only& operator=(const Only&) = delete;
  ~Only() { choose(0); }

 private:
  static void choose(std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

}  // namespace

TEST(Details, BothBackendsSeeTheSameInEveryPixel) {
  for (const double hills : {0.0, 40.0}) {
    MadeForest forest;
    forest.hills_m = hills;
    const scene::Scene scene = made_ground(forest);
    const auto rays = rays_to(scene, 200000, 7);
    const auto nested = nearest(*accel::make_nested(scene), rays);
    const auto exact = nearest(*accel::make_embree(scene, accel::Flat::exact), rays);
    const Difference d = difference(scene, rays, nested, exact, 1e-5);
    EXPECT_GT(d.details, 60000);
    // Rays that pass an edge within the last bits of a float.
    EXPECT_LE(d.things, 20) << "hills " << hills;
    EXPECT_LE(d.depths, 20) << "hills " << hills;
    const auto flat = nearest(*accel::make_embree(scene), rays);
    const Difference plain = difference(scene, rays, nested, flat, 2e-3);
    EXPECT_LE(plain.things, 1500) << "hills " << hills;  // world space in floats
    EXPECT_LE(plain.depths, 1500) << "hills " << hills;
    RecordProperty("exact_things", d.things);
    RecordProperty("flat_things", plain.things);
  }
}

// Without any tree: each instance of Details itself, at the place that Details says.
TEST(Details, AreWhatAskingEveryInstanceFinds) {
  scene::Scene scene = made_forest({});
  const auto tile = made_tile(200);
  const scene::DetailKind kind = kind_in(scene, tile);
  MadeGround made;
  made.west = made.south = -3;
  made.east = made.north = 3;
  const auto details = made_details(scene, tile, made);
  scene.details.push_back(scene::make_detail_layer(kind, details, scene.origin, "one"));
  ASSERT_EQ(scene.details[0].count(), details.count());
  std::map<std::uint32_t, std::tuple<int, int, std::uint16_t>> numbered;  // as Details have them
  for (std::size_t t = 0; t < details.tiles.size(); ++t)
    for (const std::uint16_t c : details.of(t))
      numbered[static_cast<std::uint32_t>(numbered.size())] = {details.tiles[t].x, details.tiles[t].y, c};
  ASSERT_LT(details.count() + 20, details.chosen.size()) << "some should be refused";
  silvasim::base::Stream random(3, silvasim::base::Purpose::rotation, 18);
  const auto between = [&](double a, double b) { return a + (b - a) * random.next_double(); };
  std::vector<Ray> rays(4000);
  const double height = scene::ground_at(scene.ground, 0, 0).height_m;
  for (Ray& ray : rays) {
    ray.origin = {between(-4, 4), between(-4, 4), height + between(-1, 3)};
    ray.direction = V3(V3d(between(-1, 1), between(-1, 1), between(-1, 0.5)).normalized()).normalized();
    if (random.next_below(3) == 0) ray.least = between(0, 2);
    if (random.next_below(3) == 0) ray.most = between(0.5, 4);
  }
  std::vector<Hit> hits(rays.size());
  accel::trace_details(scene, rays, hits);
  int met = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    double best = rays[i].most;
    std::tuple<int, int, std::uint16_t> where{0, 0, 0};
    bool found = false;
    for (std::size_t t = 0; t < details.tiles.size(); ++t) {
      for (const std::uint16_t c : details.of(t)) {
        const auto& candidate = tile.candidates[c];
        const V3d at(details.tiles[t].x * 0.5 - scene.origin.x + static_cast<double>(candidate.at.x),
                     details.tiles[t].y * 0.5 - scene.origin.y + static_cast<double>(candidate.at.y),
                     details.tiles[t].z * 0.5 + static_cast<double>(candidate.at.z));
        if ((at - rays[i].origin).cross(V3d(rays[i].direction)).length() > 0.4) continue;
        const scene::DetailFrame& frame = scene.details[0].frames[c];
        const V3d corner = at - V3d(candidate.at);
        const scene::LocalRay local = scene::detail_ray(frame, corner, rays[i].origin, rays[i].direction);
        accel::ModelRay ray{local.origin, local.direction,
                            static_cast<float>((rays[i].least - local.start) / static_cast<double>(frame.scale))};
        accel::ModelPoint point;
        accel::trace_model(*scene.models[frame.model], {&ray, 1}, {&point, 1});
        const double distance = local.start + static_cast<double>(point.t) * static_cast<double>(frame.scale);
        if (!(distance < best) || distance < rays[i].least) continue;
        best = distance;
        found = true;
        where = {details.tiles[t].x, details.tiles[t].y, c};
        // The hit's point, moved by the candidate itself, lies on the ray.
        const V3 local_point = local.origin + local.direction * point.t;
        const V3d world = corner + V3d(candidate(local_point));
        EXPECT_LT((world - (rays[i].origin + V3d(rays[i].direction) * distance)).length(), 1e-4);
      }
    }
    ASSERT_EQ(hits[i].surface == Surface::detail, found) << i;
    if (!found) continue;
    ++met;
    EXPECT_NEAR(hits[i].distance, best, 1e-6) << i;
    EXPECT_EQ((std::tuple{hits[i].column, hits[i].row, scene.details[0].chosen[hits[i].site_slot]}), where) << i;
    EXPECT_EQ(numbered.at(scene::detail_number(scene.details[0], hits[i].site_slot)), where) << i;
  }
  EXPECT_GT(met, 500);
}

TEST(Details, BarLightWhereTheyAreMet) {
  const scene::Scene scene = made_ground();
  auto rays = rays_to(scene, 60000, 9);
  for (std::size_t i = 0; i < rays.size(); i += 2) rays[i].most = 1.2;
  for (std::size_t i = 0; i < rays.size(); i += 3) rays[i].least = 0.7;
  const auto tracer = accel::make_nested(scene);
  const auto hits = nearest(*tracer, rays);
  std::vector<std::uint8_t> answers(rays.size());
  tracer->occluded(rays, answers);
  int differ = 0, details = 0, free = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    differ += (hits[i].surface != Surface::none) != (answers[i] != 0);
    details += hits[i].surface == Surface::detail ? 1 : 0;
    free += answers[i] == 0 ? 1 : 0;
    if (hits[i].surface == Surface::detail) {
      EXPECT_GE(hits[i].distance, rays[i].least);
      EXPECT_LE(hits[i].distance, rays[i].most);
    }
  }
  EXPECT_EQ(differ, 0);
  EXPECT_GT(details, 10000);
  EXPECT_GT(free, 3000);
}

TEST(Details, AreMetAlikeAloneAndTogetherAndByAnyInstructionSet) {
  scene::Scene scene = made_ground();
  for (scene::DetailLayer& layer : scene.details) layer.fades = true;
  auto rays = rays_to(scene, 20000, 11);
  silvasim::base::Stream random(2, silvasim::base::Purpose::rotation, 19);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (i % 16 != 0) {
      rays[i] = rays[i / 16 * 16];
      const V3 by(random.next_float() - 0.5f, random.next_float() - 0.5f, random.next_float() - 0.5f);
      rays[i].direction = (rays[i].direction + by * 0.02f).normalized();
    }
    if (i / 16 % 2 == 1) rays[i].spread = 0.002f;
  }
  const auto tracer = accel::make_nested(scene);
  const auto together = nearest(*tracer, rays);
  std::vector<std::uint8_t> barred(rays.size()), barred_alone(rays.size());
  tracer->occluded(rays, barred);
  int other = 0, details = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Hit alone;
    tracer->nearest({&rays[i], 1}, {&alone, 1});
    tracer->occluded({&rays[i], 1}, {&barred_alone[i], 1});
    other += same(alone, together[i]) ? 0 : 1;
    details += alone.surface == Surface::detail ? 1 : 0;
  }
  EXPECT_EQ(other, 0);
  EXPECT_EQ(barred, barred_alone);
  EXPECT_GT(details, 5000);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const Only only(target);
    const auto hits = nearest(*tracer, rays);
    int differ = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) differ += same(hits[i], together[i]) ? 0 : 1;
    EXPECT_EQ(differ, 0) << hwy::TargetName(target);
  }
}

// The wider a ray, the fewer it meets, one by one and never again; and none where a layer does not fade.
TEST(Details, FadeOneByOneAsRaysWiden) {
  scene::Scene scene = made_ground();
  auto rays = rays_to(scene, 40000, 13);
  const auto full = nearest(*accel::make_nested(scene), rays);
  for (const bool fades : {false, true}) {
    for (scene::DetailLayer& layer : scene.details) layer.fades = fades;
    const auto tracer = accel::make_nested(scene);
    std::vector<int> met;
    const float most = std::max(scene.details[0].most_faded(), scene.details[1].most_faded());
    std::map<std::tuple<int, int, int, std::uint32_t>, float> widest;  // that an instance was met with
    for (const float part : {0.0f, 0.02f, 0.1f, 0.3f, 0.5f, 0.7f, 0.9f, 1.01f}) {
      for (Ray& ray : rays) ray.width_m = part * most;
      const auto hits = nearest(*tracer, rays);
      int count = 0;
      for (std::size_t i = 0; i < hits.size(); ++i) {
        if (hits[i].surface != Surface::detail) continue;
        ++count;
        if (!fades) continue;
        const scene::DetailLayer& layer = scene.details[hits[i].layer];
        const scene::DetailFrame& frame = layer.frames[layer.chosen[hits[i].site_slot]];
        EXPECT_LE(rays[i].width_m, 2 * 1.25f * frame.size_m);
      }
      met.push_back(count);
      if (part <= 0.02f) {
        EXPECT_EQ(difference(scene, rays, full, hits, 0).things, 0);
      }
    }
    if (!fades) {
      for (const int count : met) EXPECT_EQ(count, met[0]);
    } else {
      for (std::size_t k = 1; k < met.size(); ++k) EXPECT_LE(met[k], met[k - 1]);
      EXPECT_LT(met[5], met[0] * 8 / 10);
      EXPECT_GT(met[5], 0);
      EXPECT_EQ(met.back(), 0);
    }
  }
}

// Ground takes over what is left out: nothing for narrow rays, all for wide ones, and only where details lie.
TEST(Details, CoverTheGroundBeneathByTheirShareAndColour) {
  scene::Scene scene = made_ground();
  scene::DetailLayer& layer = scene.details[0];
  layer.fades = true;
  const auto at = [&](double x, double y) { return V3d(x, y, scene::ground_at(scene.ground, x, y).height_m); };
  int there = 0;
  for (double x = -19.3; x < 17; x += 0.9) {
    for (double y = -19.1; y < 19; y += 0.9) {
      EXPECT_EQ(scene::detail_cover(layer, at(x, y), 0).share, 0);
      const scene::DetailCover half = scene::detail_cover(layer, at(x, y), 0.6f * layer.most_faded()),
                               all = scene::detail_cover(layer, at(x, y), 10);
      EXPECT_LE(half.share, all.share);
      EXPECT_LT(all.share, 1);
      there += all.share > 0.05f ? 1 : 0;
      EXPECT_EQ(scene::detail_cover(layer, at(x, y) + V3d(0, 0, 9), 10).share, 0) << "far above";
    }
  }
  EXPECT_NEAR(there / (41.0 * 43.0), 0.8, 0.06);  // every fifth column of tiles has none
  EXPECT_EQ(scene::detail_cover(layer, at(-25, 0), 10).share, 0);
  EXPECT_EQ(scene::detail_cover(layer, at(0, 25), 10).share, 0);
  layer.fades = false;
  EXPECT_EQ(scene::detail_cover(layer, at(0, 0), 10).share, 0);
}

TEST(Details, CostLittleHoweverManyAndHoweverFarApart) {
  scene::Scene scene = made_forest({});
  const auto tile = made_tile(1000);
  const scene::DetailKind kind = kind_in(scene, tile);
  ghosttile::fill::Details details;
  details.first.push_back(0);
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 100; ++x) {
      for (std::uint16_t c = 0; c < 1000; c = static_cast<std::uint16_t>(c + 20)) details.chosen.push_back(c);
      details.tiles.push_back({x, y, x % 3});
      details.instances.push_back(50);
      details.first.push_back(static_cast<std::uint32_t>(details.chosen.size()));
    }
  }
  const scene::DetailLayer layer = scene::make_detail_layer(kind, details, scene.origin, "many");
  ASSERT_EQ(layer.count(), 500000u);
  RecordProperty("bytes_an_instance_of_50_a_tile", std::to_string(static_cast<double>(layer.instances_bytes()) / 5e5));
  EXPECT_LT(layer.instances_bytes(), 4u * 500000u);

  ghosttile::fill::Details apart;
  apart.tiles = {{-60000, -60000, 0}, {60000, 60000, 3}};
  apart.instances = {2, 2};
  apart.chosen = {0, 1, 0, 1};
  apart.first = {0, 2, 4};
  scene.origin = {0, 0};
  scene.details.push_back(scene::make_detail_layer(kind, apart, scene.origin, "apart"));
  EXPECT_LT(scene.details[0].instances_bytes(), 10000u);
  // Straight down onto a leaf of each.
  for (const auto& place : apart.tiles) {
    int met = 0;
    for (int i = 0; i < 400; ++i) {
      Ray ray;
      ray.origin = V3d(place.x, place.y, place.z) * 0.5 + V3d(i % 20 * 0.025, i / 20 * 0.025, 3);
      ray.direction = V3(0, 0, -1);
      Hit hit;
      accel::trace_details(scene, {&ray, 1}, {&hit, 1});
      if (hit.surface == Surface::none) continue;
      ++met;
      EXPECT_EQ(hit.column, place.x);
      EXPECT_EQ(hit.row, place.y);
    }
    EXPECT_GT(met, 5);
  }
}

TEST(Details, OfNothingAreNothing) {
  scene::Scene scene = made_forest({});
  const auto tile = made_tile(20);
  const scene::DetailKind kind = kind_in(scene, tile);
  ghosttile::fill::Details none;
  none.tiles = {{0, 0, 0}};
  none.first = {0, 3};
  none.chosen = {1, 2, 3};  // refused, all of them
  none.instances = {0};
  scene.details.push_back(scene::make_detail_layer(kind, {}, scene.origin, "empty"));
  scene.details.push_back(scene::make_detail_layer(kind, none, scene.origin, "refused"));
  scene::number_details(scene);
  const auto rays = rays_to(scene, 2000, 15);
  for (const auto& hits :
       {nearest(*accel::make_nested(scene), rays), nearest(*accel::make_embree(scene, accel::Flat::exact), rays)})
    for (const Hit& hit : hits) EXPECT_NE(hit.surface, Surface::detail);
  EXPECT_EQ(scene.details[1].count(), 0u);
  EXPECT_EQ(scene::detail_cover(scene.details[1], {0, 0, 0}, 10).share, 0);
}

}  // namespace silvavis::testing
