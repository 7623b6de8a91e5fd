// Ground detail for a picture: from files of details, or filled around the eyes from a scene of details.
//
// Promise: what is filled at a place is the same wherever the eyes are (ghosttile/fill/fill.h).
// Errors: base::Error and base::ConfigError of ghosttile.
#pragma once

#include <filesystem>
#include <vector>

#include "ghosttile/fill/file.h"
#include "silvasim/base/progress.h"
#include "silvasim/ecosystem/ecosystem.h"
#include "silvavis/base/vector.h"

namespace silvavis::commands {

// `file`: .details, or the XML of a scene, which is filled within `radius_m` of each eye (scene coordinates); without eyes over all of
// its land.
ghosttile::fill::DetailsFile details_of(const std::filesystem::path& file, const std::vector<V3d>& eyes,
                                        double radius_m, const silvasim::base::Progress& progress);

// Bare, flat land at height 0 under details that were filled without an ecosystem.
silvasim::ecosystem::Ecosystem land_under(const ghosttile::fill::DetailsFile& details);

}  // namespace silvavis::commands
