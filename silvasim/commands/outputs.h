// What a command may write, settled before its work begins.
#pragma once

#include <vector>

#include "silvasim/commands/commands.h"

namespace silvasim::commands {

// The files that appear when an output of this name is written: a PNG brings its world file and its CRS along.
std::vector<Path> files_of_output(const Path& output);

// Refuses outputs that are inputs (or belong to one, as a shapefile's .prj does), that are each other, or that cannot be
// written by their name.
// Errors: base::ConfigError, base::Error.
void check_outputs(const std::vector<Path>& outputs, const std::vector<Path>& inputs);

}  // namespace silvasim::commands
