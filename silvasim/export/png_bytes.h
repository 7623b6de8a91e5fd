// Pixels as a PNG file's bytes, and a layout drawn over them.
//
// Errors: base::Error where cairo fails (out of memory).
#pragma once

#include <string>

#include "silvasim/export/cover.h"
#include "silvasim/export/layout.h"

namespace silvasim::exports {

std::string png_of(const Pixels& pixels);

// The whole picture: the page, the map's pixels where the layout wants them, and its parts over them.
std::string png_of(const Layout& layout, const Pixels& map);

}  // namespace silvasim::exports
