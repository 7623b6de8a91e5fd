// Flights over made land: that they keep their promises wherever the points lie.
#include "silvavis/commands/flight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "silvasim/base/error.h"

namespace silvavis::commands {
namespace {

constexpr double pi = 3.14159265358979;

// Ridges and hollows of 60 m, 10 m cells, 2 km square.
scene::Ground made_ground() {
  silvasim::ecosystem::Terrain terrain;
  terrain.columns = terrain.rows = 200;
  terrain.west = -1000;
  terrain.north = 1000;
  terrain.cell_width_m = terrain.cell_height_m = 10;
  for (int row = 0; row < 200; ++row) {
    for (int column = 0; column < 200; ++column)
      terrain.heights_m.push_back(static_cast<float>(300 + 60 * std::sin(column * 0.21) * std::cos(row * 0.17)));
  }
  return scene::make_ground(terrain, {-1000, -1000, 1000, 1000}, {0, 0});
}

PathPoint at(double x, double y, double z) {
  PathPoint point;
  point.eye = {x, y, z};
  point.height_m = z;
  return point;
}

double angle_between(const Flight::View& a, const Flight::View& b) {
  const V3d p = (a.look_at - a.eye).normalized(), q = (b.look_at - b.eye).normalized();
  return std::acos(std::clamp(p.dot(q), -1.0, 1.0)) * 180 / pi;
}

// Whatever the points, also beneath the ground and outside of it: never nearer to it than 2 m, never faster than asked,
// and as long as it says.
TEST(Flight, StaysAboveTheGroundAtConstantSpeed) {
  const scene::Ground ground = made_ground();
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-1300, 1300), height(150, 500);
    FlightPath path;
    const bool above_ground = seed % 3 == 0;
    for (unsigned i = 0; i < 2 + seed % 7; ++i) {
      path.points.push_back(at(place(random), place(random), height(random)));
      if (above_ground) {
        path.points.back().above_ground = true;
        path.points.back().height_m = height(random) / 10;
      }
    }
    FlightOptions options;
    options.fps = 10;
    options.speed_m_s = 40;
    const Flight flight(path, ground, options);
    EXPECT_NEAR(flight.duration_s(), flight.length_m() / 40, 1e-6);
    double sum = 0;
    for (int k = 1; k <= flight.frames(); ++k) {
      const Flight::View view = flight.frame(k);
      const double clear = view.eye.z - scene::ground_at(ground, view.eye.x, view.eye.y).height_m;
      ASSERT_GE(clear, above_ground ? 15 - 1e-6 : 2 - 1e-6) << "frame " << k;
      ASSERT_GT((view.look_at - view.eye).length(), 1e-3);
      if (k == 1) continue;
      const double step = (view.eye - flight.frame(k - 1).eye).length();
      ASSERT_LE(step, 4 * 1.001) << "frame " << k;
      sum += step;
    }
    EXPECT_NEAR(sum, flight.length_m(), 0.02 * flight.length_m() + 4);
  }
}

TEST(Flight, GoesThroughItsPointsAndLiftsNothingThatIsHighEnough) {
  const scene::Ground ground = made_ground();
  FlightPath path;
  path.points = {at(-500, -500, 700), at(0, 200, 650), at(300, -100, 720), at(800, 800, 600)};
  const double times[] = {2, 5, 6, 20};
  for (std::size_t i = 0; i < 4; ++i) path.points[i].time_s = times[i];
  const Flight flight(path, ground, {});
  EXPECT_DOUBLE_EQ(flight.duration_s(), 18);
  EXPECT_EQ(flight.frames(), 18 * 25 + 1);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((flight.at(times[i] - 2).eye - path.points[i].eye).length(), 0.05) << i;
}

TEST(Flight, LooksAtItsPlaces) {
  const scene::Ground ground = made_ground();
  FlightPath path;
  path.points = {at(-500, 0, 700), at(0, 300, 700), at(500, 0, 700)};
  for (PathPoint& point : path.points) point.look_at = V3d(0, 0, 400);
  const Flight flight(path, ground, {});
  for (double t = 0; t <= flight.duration_s(); t += 0.7)
    EXPECT_LT((flight.at(t).look_at - V3d(0, 0, 400)).length(), 1e-6);
}

TEST(Flight, TurnsTheShorterWayAndSmoothly) {
  const scene::Ground ground = made_ground();
  FlightPath path;
  path.points = {at(0, 0, 700), at(0, 400, 700), at(0, 800, 700)};
  path.points[0].heading_deg = 350;
  path.points[1].heading_deg = 10;
  path.points[2].heading_deg = -330;
  FlightOptions options;
  options.fps = 50;
  const Flight flight(path, ground, options);
  double turned = 0;
  for (int k = 2; k <= flight.frames(); ++k) {
    const double step = angle_between(flight.frame(k - 1), flight.frame(k));
    EXPECT_LT(step, 0.1);
    turned += step;
  }
  EXPECT_NEAR(turned, 40, 0.5);
}

// A zigzag: the way ahead turns without a jerk.
TEST(Flight, LooksAheadSmoothly) {
  const scene::Ground ground = made_ground();
  FlightPath path;
  for (int i = 0; i < 8; ++i) path.points.push_back(at(-700 + 200 * i, i % 2 ? 150 : -150, 500));
  const Flight flight(path, ground, {});
  double before = 0;
  for (int k = 2; k <= flight.frames(); ++k) {
    const double step = angle_between(flight.frame(k - 1), flight.frame(k));
    EXPECT_LT(step, 3);
    if (k > 2) {
      EXPECT_LT(std::abs(step - before), 0.5) << "frame " << k;
    }
    before = step;
  }
  const Flight::View first = flight.frame(1);
  const V3d look = (first.look_at - first.eye).normalized();
  EXPECT_NEAR(std::asin(look.z) * 180 / pi, -8, 3);
  EXPECT_GT(look.x, 0);
}

TEST(Flight, MayStayInOnePlace) {
  const scene::Ground ground = made_ground();
  FlightPath path;
  path.points = {at(0, 0, 700), at(0, 0, 700), at(100, 0, 700)};
  const double times[] = {0, 4, 8};
  for (std::size_t i = 0; i < 3; ++i) path.points[i].time_s = times[i];
  path.points[0].heading_deg = 0;
  path.points[1].heading_deg = 90;
  path.points[2].heading_deg = 90;
  const Flight flight(path, ground, {});
  EXPECT_LT((flight.at(3.9).eye - V3d(0, 0, 700)).length(), 1e-9);
  EXPECT_GT(angle_between(flight.at(0), flight.at(2)), 20);
  path.points.pop_back();
  const Flight still(path, ground, {});
  EXPECT_LT((still.at(2).eye - V3d(0, 0, 700)).length(), 1e-9);
  EXPECT_NEAR(angle_between(still.at(0), still.at(4)), 90, 1e-6);
}

TEST(Flight, FramesAreCountedAndBounded) {
  const scene::Ground ground = made_ground();
  FlightPath path;
  path.points = {at(0, 0, 700), at(100, 0, 700)};
  path.duration_s = 12;
  EXPECT_EQ(Flight(path, ground, {}).frames(), 301);
  path.duration_s = 86400;
  FlightOptions options;
  options.fps = 1000;
  EXPECT_THROW(Flight(path, ground, options), silvasim::base::ConfigError);
}

}  // namespace
}  // namespace silvavis::commands
