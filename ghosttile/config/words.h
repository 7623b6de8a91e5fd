// Words of XML attributes that the grammar takes as text: places and boxes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "assets/vector.h"
#include "silvasim/base/error.h"
#include "silvasim/config/node.h"

namespace ghosttile::config {

namespace xml = silvasim::config;
using Errors = std::vector<silvasim::base::Diagnostic>;

// `count` finite numbers with commas or blanks between them; zeros where errors were added.
std::vector<double> numbers(const xml::Node& node, const std::string& attribute, std::size_t least, std::size_t most,
                            Errors& errors);
assets::V3d place(const xml::Node& node, const std::string& attribute, Errors& errors);  // "x, y, z" or "x, y"

// The file that a path in the XML means.
std::filesystem::path beside(const xml::Node& node, const std::string& path);

}  // namespace ghosttile::config
