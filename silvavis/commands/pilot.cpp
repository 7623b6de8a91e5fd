#include "silvavis/commands/pilot.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace silvavis::commands {

namespace {

constexpr double radians = std::numbers::pi / 180;
constexpr double least_speed_m_s = 3, farthest_m = 200e3;

V3d axis_of(const Pilot& pilot) {
  const double heading = pilot.heading_deg * radians, pitch = pilot.pitch_deg * radians;
  return {std::sin(heading) * std::cos(pitch), std::cos(heading) * std::cos(pitch), std::sin(pitch)};
}

void keep_off_the_ground(Pilot& pilot, const scene::Ground& ground) {
  pilot.eye.z = std::max(pilot.eye.z, scene::ground_at(ground, pilot.eye.x, pilot.eye.y).height_m + least_height_m);
}

}  // namespace

Pilot pilot_of(const shade::Camera& camera, const scene::Ground& ground) {
  const V3d along = camera.look_at - camera.eye;
  Pilot pilot;
  pilot.eye = camera.eye;
  pilot.heading_deg = std::atan2(along.x, along.y) / radians;
  pilot.pitch_deg =
      std::clamp(std::atan2(along.z, std::hypot(along.x, along.y)) / radians, -steepest_deg, steepest_deg);
  keep_off_the_ground(pilot, ground);
  return pilot;
}

V3d look_at_of(const Pilot& pilot) { return pilot.eye + axis_of(pilot) * 1000.0; }

double height_above_ground_m(const Pilot& pilot, const scene::Ground& ground) {
  return pilot.eye.z - scene::ground_at(ground, pilot.eye.x, pilot.eye.y).height_m;
}

double speed_m_s(const Pilot& pilot, const scene::Ground& ground) {
  return std::max(least_speed_m_s, height_above_ground_m(pilot, ground) / 2) * pilot.pace;
}

void move(Pilot& pilot, const Push& push, double seconds, const scene::Ground& ground) {
  if (push.is_none()) return;
  const double heading = pilot.heading_deg * radians;
  const V3d right(std::cos(heading), -std::sin(heading), 0);
  const V3d way = axis_of(pilot) * push.ahead + right * push.right + V3d(0, 0, push.up);
  pilot.eye += way * (speed_m_s(pilot, ground) * seconds);
  pilot.eye.x = std::clamp(pilot.eye.x, -farthest_m, farthest_m);
  pilot.eye.y = std::clamp(pilot.eye.y, -farthest_m, farthest_m);
  pilot.eye.z = std::min(pilot.eye.z, farthest_m);
  keep_off_the_ground(pilot, ground);
}

void turn(Pilot& pilot, double right_deg, double up_deg) {
  pilot.heading_deg = std::remainder(pilot.heading_deg + right_deg, 360.0);
  pilot.pitch_deg = std::clamp(pilot.pitch_deg + up_deg, -steepest_deg, steepest_deg);
}

}  // namespace silvavis::commands
