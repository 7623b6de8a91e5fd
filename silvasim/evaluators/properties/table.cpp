// <Table><point x="0" y="0"/><point x="400" y="1"/></Table>: straight lines between points, constant outside.
#include "silvasim/config/value.h"
#include "silvasim/evaluators/properties/piecewise.h"
#include "silvasim/evaluators/properties/properties.h"

namespace silvasim::evaluators {

namespace {

std::unique_ptr<Response> make(const config::Node& node, std::vector<base::Diagnostic>& errors) {
  std::vector<CurvePoint> points = curve_points(node, errors);
  if (points.empty()) return nullptr;
  constexpr std::size_t few = 16;
  if (points.size() <= few) return std::make_unique<PiecewiseLinear>(points);
  return std::make_unique<SampledCurve>(std::move(points));
}

}  // namespace

std::vector<CurvePoint> curve_points(const config::Node& node, std::vector<base::Diagnostic>& errors) {
  std::vector<CurvePoint> points;
  double before = 0;
  for (const config::Node* point : node.all("TablePoint")) {
    const double x = point->number("x");
    if (!points.empty() && x < before) {
      errors.push_back({point->place, "<" + node.rule->tag + ">: x must not fall from point to point; x=\"" +
                                          config::to_text(x) + "\" follows \"" + config::to_text(before) + "\""});
      return {};
    }
    points.push_back({static_cast<float>(x), static_cast<float>(point->number("y"))});
    before = x;
  }
  return points;
}

PropertyType table_property() {
  return {{"Table",
           "Table",
           "A piecewise linear response through points, constant outside; two points of equal x make a step.",
           {},
           {{"TablePoint", 1, -1}},
           config::ValueType::none,
           true,
           "<Table><point x=\"300\" y=\"0\"/><point x=\"500\" y=\"1\"/><point x=\"1200\" y=\"0.2\"/></Table>"},
          make};
}

}  // namespace silvasim::evaluators
