#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <thread>
#include <vector>

#include "assets/grown/grow.h"
#include "silvasim/base/random.h"
#include "silvavis/accel/nested.h"
#include "silvavis/accel/pack.h"
#include "silvavis/impostor_of.h"
#include "silvavis/shade/own_shadow.h"

namespace silvavis::testing {

namespace {

using scene::Impostor;

scene::PlantModel grown(const char* name, double height_m, double radius_m, int triangles) {
  return accel::pack(
      assets::grown::grow(assets::grown::form_of(name, height_m, radius_m), height_m, radius_m, 3, {triangles}));
}

scene::PlantModel with_impostor(scene::PlantModel model) {
  model.impostor = std::make_shared<const Impostor>(impostor_of(model));
  return model;
}

V3 any_direction(silvasim::base::Stream& random) {
  const float sine = 2 * random.next_float() - 1, angle = 6.2831853f * random.next_float();
  const float level = std::sqrt(1 - sine * sine);
  return {level * std::cos(angle), level * std::sin(angle), sine};
}

// A ray in the direction across the model's cylinder, from the plane through the foot.
V3 any_origin(const Impostor& impostor, const V3& direction, silvasim::base::Stream& random) {
  const scene::ImpostorView view(impostor, direction);
  return view.point((2 * random.next_float() - 1) * impostor.radius_m,
                    view.bottom_m + random.next_float() * (view.top_m - view.bottom_m));
}

class OfPlants : public ::testing::TestWithParam<const char*> {};

}  // namespace

// The model itself, asked for other rays than those that the impostor is made of.
TEST_P(OfPlants, CoversWhatTheModelCovers) {
  const scene::PlantModel model = grown(GetParam(), 20, 4, 8000);
  const Impostor impostor = impostor_of(model);
  silvasim::base::Stream random(7, silvasim::base::Purpose::impostor, 1);
  constexpr int bands = 4, rays_a_band = 20000;
  for (int band = 0; band < bands; ++band) {
    int of_model = 0, of_impostor = 0;
    for (int i = 0; i < rays_a_band; ++i) {
      V3 direction = any_direction(random);
      // Evenly in the sine from straight down to straight up.
      const float sine = (static_cast<float>(band) + random.next_float()) * (2.0f / bands) - 1;
      const float level = std::hypot(direction.x, direction.y), wanted = std::sqrt(1 - sine * sine);
      direction = {direction.x / level * wanted, direction.y / level * wanted, sine};
      const V3 origin = any_origin(impostor, direction, random);
      const accel::ModelRay ray{origin, direction, -1e30f};
      accel::ModelPoint met;
      accel::trace_model(model, std::span(&ray, 1), std::span(&met, 1));
      of_model += std::isfinite(met.t);
      const std::uint32_t side = random.next_below(Impostor::sides);
      const std::uint64_t chance = scene::mixed(random.next_u32() * 0x9E3779B97F4A7C15u);
      of_impostor += scene::meet_impostor(impostor, origin, direction, side, chance) != scene::no_point;
    }
    ASSERT_GT(of_model, rays_a_band / 50);
    EXPECT_NEAR(static_cast<double>(of_impostor) / of_model, 1, 0.04) << "band " << band;
  }
}

TEST_P(OfPlants, ItsPointsLieOnTheModelAndKnowWhatBarsThem) {
  const scene::PlantModel model = with_impostor(grown(GetParam(), 20, 4, 8000));
  const Impostor& impostor = *model.impostor;
  silvasim::base::Stream random(8, silvasim::base::Purpose::impostor, 2);
  int asked = 0, barred_by_model = 0, barred_by_impostor = 0;
  while (asked < 4000) {
    const V3 direction = any_direction(random);
    const V3 origin = any_origin(impostor, direction, random);
    const std::uint64_t chance = scene::mixed(random.next_u32() * 0x9E3779B97F4A7C15u);
    const std::uint32_t met =
        scene::meet_impostor(impostor, origin, direction, random.next_below(Impostor::sides), chance);
    if (met == scene::no_point) continue;
    const Impostor::Point& point = impostor.points[met];
    ASSERT_LT(point.slot, model.blocks.size() * scene::block_size);
    const float u = static_cast<float>(point.u) / 65535, v = static_cast<float>(point.v) / 65535;
    ASSERT_LE(u + v, 1.0001f);
    const V3 a = model.position_of(point.slot, 0), b = model.position_of(point.slot, 1),
             c = model.position_of(point.slot, 2);
    const V3 at = a * (1 - u - v) + b * u + c * v;
    const V3 plane = (b - a).cross(c - a).normalized();
    ASSERT_FALSE(scene::is_hole(model, point.slot, u, v)) << "a hole's rim may be missed by rounding, not here";
    V3 towards = any_direction(random);
    towards.z = std::abs(towards.z);
    const accel::ModelRay ray{at + plane * (plane.dot(towards) > 0 ? 2e-3f : -2e-3f), towards, 0};
    std::uint8_t answer = 0;
    accel::bar_model(model, std::span(&ray, 1), std::span(&answer, 1));
    barred_by_model += answer;
    barred_by_impostor += shade::is_barred(model, met, towards, chance);
    ++asked;
  }
  EXPECT_GT(barred_by_model, asked / 10);
  EXPECT_NEAR(static_cast<double>(barred_by_impostor) / asked, static_cast<double>(barred_by_model) / asked, 0.03);
}

// Two threads ask a model's points in different orders, another asks a copy alone: all are told the same.
TEST_P(OfPlants, ItsOwnShadowHangsOnNoOrder) {
  const scene::PlantModel together = with_impostor(grown(GetParam(), 20, 4, 4000));
  scene::PlantModel alone = together;
  alone.impostor = std::make_shared<const Impostor>(*together.impostor);
  struct Question {
    std::uint32_t point;
    V3 towards;
    std::uint64_t chance;
  };
  std::vector<Question> questions;
  silvasim::base::Stream random(9, silvasim::base::Purpose::impostor, 3);
  while (questions.size() < 20000) {
    const V3 direction = any_direction(random);
    const std::uint64_t chance = scene::mixed(random.next_u32() * 0x9E3779B97F4A7C15u);
    const std::uint32_t met =
        scene::meet_impostor(*together.impostor, any_origin(*together.impostor, direction, random), direction,
                             chance % Impostor::sides, chance);
    if (met == scene::no_point) continue;
    V3 towards = any_direction(random);
    towards.z = std::abs(towards.z);
    questions.push_back({met, towards, chance});
  }
  std::vector<std::uint8_t> forwards(questions.size()), backwards(questions.size()), told(questions.size());
  const auto ask = [&](const scene::PlantModel& model, bool from_end, std::vector<std::uint8_t>& answers) {
    for (std::size_t i = 0; i < questions.size(); ++i) {
      const std::size_t at = from_end ? questions.size() - 1 - i : i;
      answers[at] = shade::is_barred(model, questions[at].point, questions[at].towards, questions[at].chance);
    }
  };
  std::thread other([&] { ask(together, true, backwards); });
  ask(together, false, forwards);
  other.join();
  ask(alone, false, told);
  EXPECT_EQ(forwards, told);
  EXPECT_EQ(backwards, told);
  ask(alone, true, forwards);
  EXPECT_EQ(forwards, told) << "asked again";
}

INSTANTIATE_TEST_SUITE_P(Impostor, OfPlants, ::testing::Values("Fagus sylvatica", "Picea abies", "Betula pendula"));

}  // namespace silvavis::testing
