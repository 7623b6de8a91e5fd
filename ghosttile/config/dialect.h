// The grammar of ghosttile's three kinds of XML files: <ghosttile>, <details>, <strokes>. One table, as for silvasim, drives the
// parser, its messages, the schema and the help.
#pragma once

#include <string>
#include <vector>

#include "silvasim/config/node.h"
#include "silvasim/config/rules.h"

namespace ghosttile::config {

namespace xml = silvasim::config;

// Lives as long as the program.
const xml::Dialect& dialect();

// The element types that may stand where a density is asked for.
const std::vector<std::string>& density_types();

}  // namespace ghosttile::config
