// The Properties, one a file. To add one: its file, its line here and in property_types().
//
// Source: Silva 2013, section 4.2.1; docs/reading.md, B3.
#pragma once

#include <vector>

#include "silvasim/evaluators/properties/piecewise.h"
#include "silvasim/evaluators/response.h"

namespace silvasim::evaluators {

PropertyType constant_property();
PropertyType minmax_property();
PropertyType gauss_property();
PropertyType bezier_property();
PropertyType table_property();
PropertyType trapezoid_property();
PropertyType classes_property();

// The <point> children of a Table or Bezier; empty, with an error, where x falls.
std::vector<CurvePoint> curve_points(const config::Node& node, std::vector<base::Diagnostic>& errors);

}  // namespace silvasim::evaluators
