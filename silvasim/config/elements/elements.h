// The fixed elements of the dialect, a file a family. The grammar itself is in config/rules.h; dialect.cpp joins them.
#pragma once

#include <string>
#include <vector>

#include "silvasim/config/rules.h"

namespace silvasim::config {

std::vector<ElementRule> scene_rules();  // <include>, <scene>
std::vector<ElementRule> field_rules();  // <datafield>, <vectorfield>, <derivedfield>
std::vector<ElementRule> layer_rules();  // what a vegetation layer says, from <tiles> to <corners>
std::vector<ElementRule> plant_rules();  // <plant> and what it holds

// Words to write an attribute's rule with.
inline constexpr double tiny = 1e-9;  // the least of what must be positive
AttributeRule attribute(std::string name, ValueType type, std::string help, std::string fallback = "");
AttributeRule choice(std::string name, std::vector<std::string> choices, std::string help, std::string fallback = "");
AttributeRule required(AttributeRule rule);
AttributeRule within(AttributeRule rule, double least, double most = std::numeric_limits<double>::infinity());

}  // namespace silvasim::config
