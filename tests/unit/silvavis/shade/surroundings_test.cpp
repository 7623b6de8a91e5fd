// The land around a scene: it goes on from the border, ends in a plain, and rays meet it where it is.
#include "silvavis/shade/surroundings.h"

#include <gtest/gtest.h>

#include <cmath>

#include "silvasim/base/random.h"
#include "silvavis/shade/atmosphere.h"

namespace silvavis::shade {
namespace {

// Hills of some 100 m on 2 x 1 km.
scene::Ground hills() {
  silvasim::ecosystem::Terrain terrain;
  terrain.columns = 100;
  terrain.rows = 50;
  terrain.cell_width_m = terrain.cell_height_m = 20;
  terrain.west = 0;
  terrain.north = 1000;
  for (int row = 0; row < terrain.rows; ++row)
    for (int column = 0; column < terrain.columns; ++column)
      terrain.heights_m.push_back(400 + 50 * std::sin(0.1f * static_cast<float>(column)) +
                                  40 * std::cos(0.15f * static_cast<float>(row)));
  return scene::make_ground(terrain, {0, 0, 2000, 1000}, {1000, 500});
}

std::vector<Rgb> colours() {
  std::vector<Rgb> all;
  for (int i = 0; i < 4 * Surroundings::parts; ++i)
    all.emplace_back(0.01f * static_cast<float>(i / Surroundings::parts + 1), 0.05f, 0.02f);
  return all;
}

Surroundings around_of(const scene::Ground& ground) {
  std::vector<Rgb> usual;
  for (std::size_t i = 0; i < Surroundings::shades; ++i)
    usual.push_back(Rgb(0.025f, 0.05f, 0.02f) * (0.6f + 0.8f * (static_cast<float>(i) + 0.5f) / Surroundings::shades));
  return Surroundings(ground, {ground.west, ground.south, ground.east(), ground.north()}, colours(), usual);
}

TEST(Surroundings, GoOnFromTheBorderAndEndAsAPlain) {
  const scene::Ground ground = hills();
  const Surroundings around = around_of(ground);
  silvasim::base::Stream stream(5, silvasim::base::Purpose::selection);
  for (int i = 0; i < 500; ++i) {
    const double t = stream.next_double();
    const V3d places[4] = {{ground.west + t * (ground.east() - ground.west), ground.south, 0},
                           {ground.east(), ground.south + t * (ground.north() - ground.south), 0},
                           {ground.west + t * (ground.east() - ground.west), ground.north(), 0},
                           {ground.west, ground.south + t * (ground.north() - ground.south), 0}};
    const V3d out[4] = {{0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
    for (int side = 0; side < 4; ++side) {
      const V3d at = places[side], near = at + out[side] * 0.01, far = at + out[side] * 3000;
      EXPECT_NEAR(around.height_at(ground, near.x, near.y), scene::ground_at(ground, at.x, at.y).height_m, 0.05);
      EXPECT_DOUBLE_EQ(around.height_at(ground, far.x, far.y), static_cast<double>(ground.pyramid.origin_m));
      // No cliffs: a metre on is nearly as high.
      const V3d there = at + out[side] * (1000 * stream.next_double()), beside = there + out[side];
      EXPECT_NEAR(around.height_at(ground, there.x, there.y), around.height_at(ground, beside.x, beside.y), 3);
    }
  }
}

TEST(Surroundings, RaysMeetThemWhereTheyAre) {
  const scene::Ground ground = hills();
  const Surroundings around = around_of(ground);
  silvasim::base::Stream stream(6, silvasim::base::Purpose::selection);
  int met = 0;
  for (int i = 0; i < 1500; ++i) {
    accel::Ray ray;
    ray.origin = {2400 * stream.next_double() - 1200, 1400 * stream.next_double() - 700,
                  520 + 800 * stream.next_double()};
    const double turn = 6.2831853 * stream.next_double(), up = 0.4 * stream.next_double() - 0.35;
    ray.direction =
        V3(static_cast<float>(std::cos(turn)), static_cast<float>(std::sin(turn)), static_cast<float>(up)).normalized();
    Surroundings::Point point;
    // Those that meet the scene itself are none of theirs.
    bool in_scene = false;
    for (double t = 0; t < 4000 && !in_scene; t += 0.1) {
      const V3d at = ray.origin + V3d(ray.direction) * t;
      const bool inside = at.x > ground.west && at.x < ground.east() && at.y > ground.south && at.y < ground.north();
      in_scene = inside && at.z < scene::ground_at(ground, at.x, at.y).height_m;
    }
    if (in_scene) continue;
    if (!around.meet(ground, ray, std::numeric_limits<double>::infinity(), point)) {
      const double above = ray.origin.z - static_cast<double>(ground.pyramid.origin_m);
      const double horizon = std::sqrt(2 * above / 6360e3);  // how far it lies below the eye's level
      if (static_cast<double>(ray.direction.z) < -1.02 * horizon)
        ADD_FAILURE() << "a ray that looks down meets no land: " << ray.direction;
      continue;
    }
    ++met;
    EXPECT_GT(point.outside_m, -1e-6);
    // On the round earth beyond the slope, which lies lower by distance^2 / 2R.
    const double away = std::hypot(point.at.x - ray.origin.x, point.at.y - ray.origin.y);
    const double drop = away * away / (2 * 6360e3);
    const double height = around.height_at(ground, point.at.x, point.at.y);
    EXPECT_LE(point.at.z, height + 0.1);
    EXPECT_GE(point.at.z, height - drop - 0.1);
    // Second way: nothing of it lies between the eye and there, outside of the scene.
    for (int k = 1; k < 400; ++k) {
      const V3d at = ray.origin + V3d(ray.direction) * (point.distance_m * k / 400);
      const bool inside = at.x > ground.west && at.x < ground.east() && at.y > ground.south && at.y < ground.north();
      if (inside) continue;
      const double r = std::hypot(at.x - ray.origin.x, at.y - ray.origin.y);
      EXPECT_GT(at.z, around.height_at(ground, at.x, at.y) - r * r / (2 * 6360e3) - 2) << k;
    }
  }
  EXPECT_GT(met, 400);
}

TEST(Surroundings, HideASceneOnlyFromEyesOutside) {
  const scene::Ground ground = hills();
  const Surroundings around = around_of(ground);
  Surroundings::Point point;
  accel::Ray ray;  // from within, to a hit within
  ray.origin = {0, 0, 600};
  ray.direction = V3(1, 0, -0.5f).normalized();
  EXPECT_FALSE(around.meet(ground, ray, 300, point));
  ray.origin = {-1400, 0, around.height_at(ground, -1400, 0) + 300};  // from outside over the slope
  ray.direction = V3(1, 0, -0.2f).normalized();
  EXPECT_FALSE(around.meet(ground, ray, 1200, point));
  ray.direction = V3(1, 0, -2).normalized();  // down to the slope before the scene
  ASSERT_TRUE(around.meet(ground, ray, 1200, point));
  EXPECT_LT(point.distance_m, 400);
  EXPECT_FALSE(Surroundings().meet(ground, ray, 1200, point));
}

TEST(Surroundings, HaveTheBordersColoursNearAndTheirMeanFar) {
  const scene::Ground ground = hills();
  const Surroundings around = around_of(ground);
  // Down on the east and the west, many times for the patches' mean.
  const auto mean = [&](double x0, double x1) {
    Rgb sum(0, 0, 0);
    int count = 0;
    silvasim::base::Stream stream(7, silvasim::base::Purpose::selection);
    for (int i = 0; i < 3000; ++i) {
      accel::Ray ray;
      ray.origin = {x0 + (x1 - x0) * stream.next_double(), 800 * stream.next_double() - 400, 5000};
      ray.direction = V3(0, 0, -1);
      Surroundings::Point point;
      if (!around.meet(ground, ray, std::numeric_limits<double>::infinity(), point)) continue;
      sum += point.reflectance;
      ++count;
    }
    return sum / static_cast<float>(count);
  };
  const Rgb east = mean(ground.east() + 0.5, ground.east() + 5), west = mean(ground.west - 5, ground.west - 0.5);
  EXPECT_NEAR(east.x / east.y, 0.02f / 0.05f, 0.06f);  // the second side
  EXPECT_NEAR(west.x / west.y, 0.04f / 0.05f, 0.06f);  // the fourth
  const Rgb far = mean(30000, 90000);
  EXPECT_NEAR(far.x / far.y, 0.025f / 0.05f, 0.02f);
  EXPECT_NEAR(far.y, 0.05f, 0.006f);  // patches make nothing lighter or darker as a whole
}

// Far out each shade has its equal share, so the land around is as light as what it goes on from; crowns and groups change no mean.
TEST(Surroundings, AreAPatchworkOfTheUsualColoursInEqualShares) {
  const scene::Ground ground = hills();
  std::vector<Rgb> usual;
  for (std::size_t i = 0; i < Surroundings::shades; ++i) {
    const float t = static_cast<float>(i) / (Surroundings::shades - 1);
    usual.emplace_back(0.02f + 0.08f * t, 0.03f + 0.06f * t * t, 0.01f + 0.05f * t);
  }
  const Surroundings around(ground, {ground.west, ground.south, ground.east(), ground.north()}, colours(), usual);
  silvasim::base::Stream stream(8, silvasim::base::Purpose::selection);
  Rgb sum(0, 0, 0), expected(0, 0, 0);
  double dark = 0;
  constexpr int count = 40000;
  for (int i = 0; i < count; ++i) {
    const Rgb colour =
        around.colour_at(2e4 + 2e5 * stream.next_double(), 2e5 * stream.next_double() - 1e5, V3(0, 0, 1), 0);
    sum += colour / count;
    dark += colour.x < 0.06f ? 1.0 / count : 0;
  }
  for (const Rgb& one : usual) expected += one / static_cast<float>(usual.size());
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], expected[c], 0.06f * expected[c]) << c;
  EXPECT_NEAR(dark, 0.5, 0.08);
  // Wide rays see the mean.
  sum = Rgb(0, 0, 0);
  for (int i = 0; i < 4000; ++i)
    sum +=
        around.colour_at(2e4 + 2e5 * stream.next_double(), 2e5 * stream.next_double() - 1e5, V3(0, 0, 1), 400) / 4000;
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], expected[c], 0.03f * expected[c]) << c;
}

TEST(Views, AreWhatWasMeasuredAndSmoothBetween) {
  Views views;
  silvasim::base::Stream stream(9, silvasim::base::Purpose::selection);
  for (Rgb& share : views.shares) share = Rgb(stream.next_float(), stream.next_float(), stream.next_float());
  for (std::size_t i = 0; i < views.shares.size(); ++i)
    EXPECT_LT((views.from(Views::direction(i)) - views.shares[i]).length(), 1e-4f) << i;
  for (int i = 0; i < 2000; ++i) {
    const float turn = 2 * pi * stream.next_float(), sine = stream.next_float(), level = std::sqrt(1 - sine * sine);
    const auto at = [&](float angle) { return views.from({std::sin(angle) * level, std::cos(angle) * level, sine}); };
    EXPECT_LT((at(turn) - at(turn + 0.001f)).length(), 0.01f);
  }
}

}  // namespace
}  // namespace silvavis::shade
