// Places in the XML files of cameras and paths: x and y in the scene's metres, or longitude and latitude, and a height above
// the sea or the ground.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "silvasim/base/error.h"
#include "silvasim/config/node.h"
#include "silvavis/scene/scene.h"

namespace silvavis::commands {

// The attributes of a spot, each named with `prefix` before it ("look-").
std::vector<silvasim::config::AttributeRule> spot_rules(const std::string& prefix, const std::string& what);

struct Spot {
  V3d at{0, 0, 0};            // world space; z above the sea
  double height_m = 0;        // as written
  bool above_ground = false;  // what the height counts from
};

// None where nothing of it is written, or where what is written is wrong: then an error is added. Beyond the terrain the
// ground is as at its nearest edge.
std::optional<Spot> spot_of(const silvasim::config::Node& node, const std::string& prefix, const scene::Scene& scene,
                            std::vector<silvasim::base::Diagnostic>& errors);

// Degrees of WGS 84 to world x and y. None: the scene has no CRS, or the place is not on its map.
std::optional<silvasim::base::Point> world_from_degrees(const scene::Scene& scene, double longitude_deg,
                                                        double latitude_deg);

}  // namespace silvavis::commands
