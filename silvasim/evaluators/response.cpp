#include "silvasim/evaluators/response.h"

#include "silvasim/evaluators/properties/properties.h"

namespace silvasim::evaluators {

const std::vector<PropertyType>& property_types() {
  static const std::vector<PropertyType> types = {
      constant_property(), minmax_property(),    gauss_property(),   bezier_property(),
      table_property(),    trapezoid_property(), classes_property(),
  };
  return types;
}

std::unique_ptr<Response> make_response(const config::Node& node, std::vector<base::Diagnostic>& errors) {
  for (const PropertyType& type : property_types()) {
    if (type.rule.type == node.rule->type) return type.make(node, errors);
  }
  return nullptr;
}

}  // namespace silvasim::evaluators
