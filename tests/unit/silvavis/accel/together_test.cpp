// What a ray meets does not depend on the rays that are asked with it.
#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "made_forest.h"
#include "same_bits.h"
#include "silvasim/base/random.h"
#include "silvavis/accel/nested.h"

namespace silvavis::testing {

namespace {

struct Family {
  const char* name;
  // Neighbours, about as far apart as `spread` says: 0 the same ray, 1 in all directions.
  std::function<accel::Ray(silvasim::base::Stream&, accel::Ray first, float spread)> neighbour;
};

V3 nudged(const V3& direction, float spread, silvasim::base::Stream& random) {
  const V3 by(random.next_float() - 0.5f, random.next_float() - 0.5f, random.next_float() - 0.5f);
  return (direction + by * spread).normalized();
}

}  // namespace

class Together : public ::testing::TestWithParam<float> {};

TEST_P(Together, RaysMeetWhatTheyMeetAlone) {
  const float spread = GetParam();
  const scene::Scene scene = made_forest({});
  const auto tracer = accel::make_nested(scene);
  silvasim::base::Stream random(9, silvasim::base::Purpose::rotation);
  const auto between = [&](double a, double b) { return a + (b - a) * random.next_double(); };
  const std::vector<Family> families = {
      {"from an eye",
       [&](silvasim::base::Stream& draws, accel::Ray ray, float apart) {
         ray.direction = nudged(ray.direction, apart, draws);
         return ray;
       }},
      {"parallel, as towards the sun",
       [&](silvasim::base::Stream& draws, accel::Ray ray, float apart) {
         ray.origin += V3d((draws.next_double() - 0.5) * 200, (draws.next_double() - 0.5) * 200,
                           (draws.next_double() - 0.5) * 20) *
                       static_cast<double>(apart);
         return ray;
       }},
      {"each with its own ends and width", [&](silvasim::base::Stream& draws, accel::Ray ray, float apart) {
         ray.direction = nudged(ray.direction, apart, draws);
         ray.least = draws.next_double() < 0.5 ? 0 : 100 * draws.next_double();
         ray.most = draws.next_double() < 0.5 ? ray.most : ray.least + 300 * draws.next_double();
         ray.width_m = draws.next_float();
         ray.spread = 0.01f * draws.next_float();
         return ray;
       }}};
  for (const Family& family : families) {
    std::vector<accel::Ray> rays;
    while (rays.size() < 20000) {
      accel::Ray first;
      const double far = rays.size() % 2 == 0 ? 3000 : 0;
      first.origin = {between(scene.extent.west - far, scene.extent.east + far),
                      between(scene.extent.south - far, scene.extent.north + far), between(270, 400 + far / 4)};
      const V3d target(between(scene.extent.west, scene.extent.east), between(scene.extent.south, scene.extent.north),
                       between(270, 340));
      first.direction = V3((target - first.origin).normalized()).normalized();
      if (random.next_double() < 0.05) first.direction = {0, 0, -1};
      if (random.next_double() < 0.05) first.direction = {1, 0, 0};
      if (random.next_double() < 0.05) first.direction = {0, -1, 0};
      const auto count = static_cast<int>(between(1, 40));
      for (int i = 0; i < count; ++i) rays.push_back(family.neighbour(random, first, spread));
    }
    std::vector<accel::Hit> together(rays.size()), alone(rays.size());
    std::vector<std::uint8_t> barred_together(rays.size()), barred_alone(rays.size());
    tracer->nearest(rays, together);
    tracer->occluded(rays, barred_together);
    std::size_t plants = 0, other = 0, other_barred = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      tracer->nearest({&rays[i], 1}, {&alone[i], 1});
      tracer->occluded({&rays[i], 1}, {&barred_alone[i], 1});
      plants += alone[i].surface == accel::Surface::plant ? 1 : 0;
      other += same(together[i], alone[i]) ? 0 : 1;
      other_barred += barred_together[i] == barred_alone[i] ? 0 : 1;
    }
    EXPECT_GT(plants, rays.size() / 10) << family.name;
    EXPECT_EQ(other, 0u) << family.name;
    EXPECT_EQ(other_barred, 0u) << family.name;
  }
}

// From the same ray to rays of which some part from the others.
INSTANTIATE_TEST_SUITE_P(Spreads, Together, ::testing::Values(0.0f, 0.001f, 0.02f, 0.1f, 0.3f));

}  // namespace silvavis::testing
