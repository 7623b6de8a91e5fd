// Rules in the XML.
//
//   <where>
//     <response><litter species="Fagus sylvatica, Quercus" reach="2 m"/></response>
//     <response><slope/><Trapezoid a="-1" b="0" c="25" d="40"/></response>
//     <response><datafield>to_water</datafield><Table><point x="0" y="0"/><point x="3" y="1"/></Table></response>
//   </where>
//
// A `response` is one source and one Property; sources that are shares already (crowncover, litter, light, patches) need none.
// Errors: what is wrong beyond the grammar is appended to `errors` with its place; the rule is then null.
#pragma once

#include <memory>
#include <vector>

#include "ghosttile/cover/fillers.h"
#include "ghosttile/cover/land.h"
#include "ghosttile/density/field.h"
#include "silvasim/base/error.h"
#include "silvasim/config/node.h"
#include "silvasim/config/rules.h"

namespace ghosttile::cover {

// <where>, <response> and the sources. A dialect that has them needs property_rules() as well.
std::vector<silvasim::config::ElementRule> cover_rules();

// The Properties and what they hold (<class>, <point>), as silvasim's dialect has them.
std::vector<silvasim::config::ElementRule> property_rules();

// `where`: a checked <where>.
std::shared_ptr<const density::Plane> make_rule(const silvasim::config::Node& where, Land& land,
                                                std::vector<silvasim::base::Diagnostic>& errors);

// Which plants an element means by `species` (names, genera, "broadleaf", "needles", with commas between; none: all) and `layer`.
Chosen chosen_by(const silvasim::config::Node& node, const Land& land, std::vector<silvasim::base::Diagnostic>& errors);

// The attributes that chosen_by() reads, for other rooms' elements.
std::vector<silvasim::config::AttributeRule> choice_attributes();

// The source that an element of cover_rules() stands for; null where errors were added.
std::shared_ptr<const Source> make_source(const silvasim::config::Node& node, Land& land,
                                          std::vector<silvasim::base::Diagnostic>& errors);

}  // namespace ghosttile::cover
