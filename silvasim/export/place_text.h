// What a picture says about itself: where the land lies, on which coordinates, and from which run it comes.
#pragma once

#include <string>
#include <vector>

#include "silvasim/base/geometry.h"
#include "silvasim/ecosystem/ecosystem.h"

namespace silvasim::exports {

// Centre in latitude and longitude (where the CRS tells it), name of the CRS, extent: the subtitle's parts.
std::vector<std::string> place_of(const ecosystem::Ecosystem& ecosystem, const base::Box& box);

// "Silva 0.1.0", "seed 7": what provenance_json knows of it.
std::vector<std::string> origin_of(const ecosystem::Ecosystem& ecosystem);

}  // namespace silvasim::exports
