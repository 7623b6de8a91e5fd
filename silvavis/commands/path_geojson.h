// The GeoJSON part of path.h.
#pragma once

#include "silvavis/commands/path.h"

namespace silvavis::commands {

FlightPath read_geojson_path(const std::filesystem::path& file, const scene::Scene& scene,
                             std::optional<double> height_above_ground_m);

}  // namespace silvavis::commands
