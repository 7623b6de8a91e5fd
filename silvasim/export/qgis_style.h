// The style by which QGIS draws exported plants: a category a species in its colour, circles as wide as the crowns.
#pragma once

#include <string>

#include "silvasim/ecosystem/ecosystem.h"

namespace silvasim::exports {

// A QML document for a point layer with the columns "species" and "crown_radius_m" (QGIS 3).
std::string qgis_style(const ecosystem::Ecosystem& ecosystem);

}  // namespace silvasim::exports
