// <Trapezoid a="300" b="500" c="900" d="1200"/>: 0 up to a, rising to 1 at b, 1 to c, falling to 0 at d.
#include "silvasim/config/value.h"
#include "silvasim/evaluators/properties/piecewise.h"
#include "silvasim/evaluators/properties/properties.h"

namespace silvasim::evaluators {

namespace {

std::unique_ptr<Response> make(const config::Node& node, std::vector<base::Diagnostic>& errors) {
  const double a = node.number("a"), b = node.number("b"), c = node.number("c"), d = node.number("d");
  const double corners[] = {a, b, c, d};
  for (int i = 0; i < 3; ++i) {
    if (corners[i] <= corners[i + 1]) continue;
    const auto said = [&](int k) { return std::string(1, "abcd"[k]) + "=\"" + config::to_text(corners[k]) + "\""; };
    errors.push_back({node.place, "<Trapezoid>: a, b, c, d must not fall: " + said(i) + " is above " + said(i + 1)});
    return nullptr;
  }
  return std::make_unique<PiecewiseLinear>(std::vector<CurvePoint>{
      {static_cast<float>(a), 0}, {static_cast<float>(b), 1}, {static_cast<float>(c), 1}, {static_cast<float>(d), 0}});
}

}  // namespace

PropertyType trapezoid_property() {
  return {{"Trapezoid",
           "Trapezoid",
           "0 up to a, rising to 1 at b, 1 to c, falling to 0 at d.",
           {{"a", config::ValueType::number, "last value of 0", true, "", {}},
            {"b", config::ValueType::number, "first value of 1", true, "", {}},
            {"c", config::ValueType::number, "last value of 1", true, "", {}},
            {"d", config::ValueType::number, "first value of 0 again", true, "", {}}},
           {},
           config::ValueType::none,
           true,
           "<Trapezoid a=\"300\" b=\"500\" c=\"900\" d=\"1200\"/>"},
          make};
}

}  // namespace silvasim::evaluators
