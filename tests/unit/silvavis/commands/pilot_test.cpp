#include "silvavis/commands/pilot.h"

#include <gtest/gtest.h>

#include <cmath>

namespace silvavis::commands::testing {

namespace {

// Flat at 100 m in the west, rising one in two from x = 0 on.
scene::Ground slope() {
  scene::Ground ground;
  ground.columns = 201;
  ground.rows = 201;
  ground.west = ground.south = -1000;
  ground.cell_x_m = ground.cell_y_m = 10;
  for (int row = 0; row < ground.rows; ++row)
    for (int column = 0; column < ground.columns; ++column)
      ground.heights_m.push_back(100 + static_cast<float>(std::max(0.0, (ground.west + 10 * column) / 2)));
  return ground;
}

Pilot looking(double heading_deg, double pitch_deg) {
  Pilot pilot;
  pilot.eye = {-500, 0, 140};
  pilot.heading_deg = heading_deg;
  pilot.pitch_deg = pitch_deg;
  return pilot;
}

}  // namespace

TEST(Pilot, FliesWhereItLooks) {
  const scene::Ground ground = slope();
  Pilot pilot = looking(90, 0);
  EXPECT_DOUBLE_EQ(height_above_ground_m(pilot, ground), 40);
  EXPECT_DOUBLE_EQ(speed_m_s(pilot, ground), 20);
  move(pilot, {1, 0, 0}, 2, ground);
  EXPECT_LT((pilot.eye - V3d(-460, 0, 140)).length(), 1e-9);  // east
  move(pilot, {0, 1, 0}, 2, ground);
  EXPECT_LT((pilot.eye - V3d(-460, -40, 140)).length(), 1e-9);  // its right is south
  pilot.pace = 3;
  move(pilot, {0, 0, 1}, 0.5, ground);
  EXPECT_LT((pilot.eye - V3d(-460, -40, 170)).length(), 1e-9);
  Pilot diving = looking(0, -30);
  move(diving, {1, 0, 0}, 1, ground);
  EXPECT_LT((diving.eye - V3d(-500, 20 * std::sqrt(0.75), 130)).length(), 1e-9);
}

TEST(Pilot, StaysAboveTheGround) {
  const scene::Ground ground = slope();
  Pilot pilot = looking(90, -60);
  for (int i = 0; i < 400; ++i) {
    move(pilot, {1, 0, 0}, 0.1, ground);
    ASSERT_GE(pilot.eye.z, scene::ground_at(ground, pilot.eye.x, pilot.eye.y).height_m + least_height_m - 1e-9);
  }
  EXPECT_GT(pilot.eye.x, -490) << "it stuck in the ground";
  shade::Camera buried;
  buried.eye = {100, 100, 0};
  buried.look_at = {200, 100, 0};
  EXPECT_DOUBLE_EQ(pilot_of(buried, ground).eye.z, 150 + least_height_m);
}

TEST(Pilot, KnowsTheCameraItCameFrom) {
  const scene::Ground ground = slope();
  for (const V3d& along : {V3d(3, 4, -1), V3d(-100, 2, 30), V3d(0, -7, 0), V3d(1, 1, -50)}) {
    shade::Camera camera;
    camera.eye = {-20, 30, 300};
    camera.look_at = camera.eye + along;
    const Pilot pilot = pilot_of(camera, ground);
    const V3d axis = (look_at_of(pilot) - pilot.eye).normalized();
    EXPECT_LT((axis - along.normalized()).length(), 1e-9) << along;
  }
  shade::Camera down;
  down.eye = {0, 0, 500};
  down.look_at = {0, 0, 0};
  EXPECT_EQ(pilot_of(down, ground).pitch_deg, -steepest_deg);
  Pilot pilot = looking(170, 80);
  turn(pilot, 20, 20);
  EXPECT_DOUBLE_EQ(pilot.heading_deg, -170);
  EXPECT_DOUBLE_EQ(pilot.pitch_deg, steepest_deg);
}

}  // namespace silvavis::commands::testing
