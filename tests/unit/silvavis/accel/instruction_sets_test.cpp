// Whatever machine a picture is made on, its rays meet the same.
#include <gtest/gtest.h>

// As in silvavis/accel/nested.cpp: what its kernel is compiled for.
#define HWY_DISABLED_TARGETS (HWY_AVX3 | HWY_AVX3_DL | HWY_SSSE3)
#include <hwy/highway.h>
#include <hwy/targets.h>

#include <vector>

#include "made_forest.h"
#include "same_bits.h"
#include "silvasim/base/random.h"
#include "silvavis/accel/nested.h"
#include "silvavis/accel/pack.h"

namespace silvavis::testing {

namespace {

// Lets the kernel run with one instruction set, and with the machine's best again when it goes.
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

struct Answers {
  std::vector<accel::Hit> hits;
  std::vector<std::uint8_t> barred;
  std::vector<accel::ModelPoint> points;
};

}  // namespace

TEST(InstructionSets, AllGiveTheSameBits) {
  const scene::Scene scene = made_forest({});
  const auto tracer = accel::make_nested(scene);
  const scene::PlantModel model = accel::pack(leaf_ball(500, 20, 4, true, 2));
  silvasim::base::Stream random(5, silvasim::base::Purpose::rotation);
  const auto between = [&](double a, double b) { return a + (b - a) * random.next_double(); };
  std::vector<accel::Ray> rays(60000);
  std::vector<accel::ModelRay> model_rays(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    accel::Ray& ray = rays[i];
    const double far = i % 3 == 0 ? 5000 : 0;
    ray.origin = {between(scene.extent.west - far, scene.extent.east + far),
                  between(scene.extent.south - far, scene.extent.north + far), between(270, 400 + far / 4)};
    const V3d target(between(scene.extent.west, scene.extent.east), between(scene.extent.south, scene.extent.north),
                     between(270, 340));
    ray.direction = V3((target - ray.origin).normalized()).normalized();
    if (i % 50 == 0) ray.direction = {0, 0, -1};
    if (i % 7 == 0) ray.most = between(1, 200);
    if (i % 11 == 0) ray.least = between(0, 50);
    // Every other sixteen go together.
    if (i / 16 % 2 == 1 && i % 16 != 0) {
      ray.origin = rays[i / 16 * 16].origin;
      ray.direction =
          (rays[i / 16 * 16].direction + V3(random.next_float(), random.next_float(), random.next_float()) * 0.004f)
              .normalized();
    }
    const float wide = 6 * random.next_float();
    model_rays[i].origin = {wide - 3, 6 * random.next_float() - 3, 22 * random.next_float() - 1};
    model_rays[i].direction =
        V3(random.next_float() - 0.5f, random.next_float() - 0.5f, random.next_float() - 0.5f).normalized();
    model_rays[i].least = -30;
  }

  const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  ASSERT_GE(targets.size(), 1u);
  std::vector<Answers> answers(targets.size());
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const Only only(targets[k]);
    answers[k].hits.resize(rays.size());
    answers[k].barred.resize(rays.size());
    answers[k].points.resize(rays.size());
    tracer->nearest(rays, answers[k].hits);
    tracer->occluded(rays, answers[k].barred);
    accel::trace_model(model, model_rays, answers[k].points);
  }

  for (std::size_t k = 1; k < targets.size(); ++k) {
    std::size_t hits = 0, other_hits = 0, other_points = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      hits += answers[0].hits[i].surface != accel::Surface::none ? 1 : 0;
      other_hits += same(answers[0].hits[i], answers[k].hits[i]) ? 0 : 1;
      const accel::ModelPoint &a = answers[0].points[i], &b = answers[k].points[i];
      other_points += same_bits(a.t, b.t) && a.slot == b.slot && same_bits(a.u, b.u) && same_bits(a.v, b.v) ? 0 : 1;
    }
    const char* const first = hwy::TargetName(targets[0]);
    const char* const second = hwy::TargetName(targets[k]);
    EXPECT_GT(hits, rays.size() / 4);
    EXPECT_EQ(other_hits, 0u) << first << " against " << second;
    EXPECT_EQ(other_points, 0u) << first << " against " << second;
    EXPECT_EQ(answers[0].barred, answers[k].barred) << first << " against " << second;
  }
  std::string names;
  for (const std::int64_t target : targets) names += std::string(names.empty() ? "" : ", ") + hwy::TargetName(target);
  RecordProperty("instruction_sets", names);
}

}  // namespace silvavis::testing
