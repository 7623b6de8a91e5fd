// What a flight is told: points for the eye, and where it looks at them. From XML, or a line of GeoJSON.
//
//   <path fps="25" duration="12 s">
//     <point x="571000" y="5725500" height="40" above="ground" look-x="571600" look-y="5725900" look-height="470"/>
//     <point x="571600" y="5725300" height="60" above="ground" heading="20" pitch="-15"/>
//   </path>
//
// GeoJSON: one LineString, alone, in a Feature or in a FeatureCollection; heights above the sea in z. Degrees of WGS 84 where
// the scene has a CRS (RFC 7946; an older "crs" member is obeyed), else the scene's metres.
// Units: world space. Errors: base::ConfigError with file, line and column.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "silvavis/scene/scene.h"

namespace silvavis::commands {

struct PathPoint {
  V3d eye{0, 0, 0};           // z above the sea
  double height_m = 0;        // as written: above the sea, or above the ground there
  bool above_ground = false;  // what it counts from
  std::optional<V3d> look_at;
  std::optional<double> heading_deg;  // clockwise from the grid's north
  double pitch_deg = 0;               // up; with heading_deg
  std::optional<double> time_s;       // at all points, ascending, or at none

  friend bool operator==(const PathPoint&, const PathPoint&) = default;
};

inline constexpr double least_distance_m = 1e-3;  // nearer than this, two points are one

struct FlightPath {
  std::vector<PathPoint> points;  // two at least
  std::optional<double> fps, duration_s, fov_deg;
};

// `height_above_ground_m`: of a GeoJSON line, instead of its own heights.
FlightPath read_path(const std::filesystem::path& file, const scene::Scene& scene,
                     std::optional<double> height_above_ground_m = {});

}  // namespace silvavis::commands
