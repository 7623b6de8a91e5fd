// Where the eye of a flight by hand is and looks, and how keys and mouse move it. Plain values.
//
// Units: world space, metres, degrees; headings clockwise from the grid's north.
#pragma once

#include "silvavis/scene/scene.h"
#include "silvavis/shade/camera.h"

namespace silvavis::commands {

struct Pilot {
  V3d eye{0, 0, 0};
  double heading_deg = 0;
  double pitch_deg = 0;  // up
  double pace = 1;       // what the mouse wheel changes

  friend bool operator==(const Pilot&, const Pilot&) = default;
};

inline constexpr double least_height_m = 0.5;  // of the eye above the ground
inline constexpr double steepest_deg = 89;

Pilot pilot_of(const shade::Camera& camera, const scene::Ground& ground);

// 1 km along the axis.
V3d look_at_of(const Pilot& pilot);

double height_above_ground_m(const Pilot& pilot, const scene::Ground& ground);

// Metres a second: half the height above the ground, at least 3; times the pace.
double speed_m_s(const Pilot& pilot, const scene::Ground& ground);

// From -1 to 1: along the axis, to the right, and straight up.
struct Push {
  double ahead = 0, right = 0, up = 0;

  bool is_none() const { return ahead == 0 && right == 0 && up == 0; }
};

// The eye stays least_height_m above the ground, and within 200 km of the scene's middle.
void move(Pilot& pilot, const Push& push, double seconds, const scene::Ground& ground);
void turn(Pilot& pilot, double right_deg, double up_deg);

}  // namespace silvavis::commands
