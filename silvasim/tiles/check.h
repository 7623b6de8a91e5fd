// What is wrong with a user's tile settings.
#pragma once

#include <vector>

#include "silvasim/base/error.h"
#include "silvasim/config/tile_settings.h"

namespace silvasim::tiles {

// All findings, at `settings.place`; empty: fill_tiles() will take them.
std::vector<base::Diagnostic> faults(const config::TileSettings& settings);

// The largest coverage that dart throwing reaches with these radii: 0.6, and less where they are nearly equal.
double most_coverage(const config::TileSettings& settings);

}  // namespace silvasim::tiles
