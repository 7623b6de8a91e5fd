// <Bezier> of 4, 7, 10, ... control points: cubic pieces, drawn from the first point to the last.
//
// A 2-D curve with monotone x (docs/reading.md, B3), so that it is a function of x. It is flattened once into 256 chords a
// piece, which are off by less than (1/256)² * |second derivative| / 8, below 0.0001 of a piece's height; looking them up
// may add as much again (smooth_curve).
#include "silvasim/evaluators/properties/piecewise.h"
#include "silvasim/evaluators/properties/properties.h"

namespace silvasim::evaluators {

namespace {

constexpr int chords = 256;

// Bernstein form, in double: p = (1-t)³ a + 3 (1-t)² t b + 3 (1-t) t² c + t³ d.
double cubic(double a, double b, double c, double d, double t) {
  const double s = 1 - t;
  return s * s * s * a + 3 * s * s * t * b + 3 * s * t * t * c + t * t * t * d;
}

std::unique_ptr<Response> make(const config::Node& node, std::vector<base::Diagnostic>& errors) {
  const std::vector<CurvePoint> controls = curve_points(node, errors);
  if (controls.empty()) return nullptr;
  if (controls.size() % 3 != 1) {
    errors.push_back({node.place, "<Bezier> has " + std::to_string(controls.size()) +
                                      " control points; cubic pieces need 4, 7, 10, ..."});
    return nullptr;
  }
  std::vector<CurvePoint> points{controls.front()};
  for (std::size_t k = 0; k + 3 < controls.size(); k += 3) {
    const CurvePoint a = controls[k], b = controls[k + 1], c = controls[k + 2], d = controls[k + 3];
    for (int i = 1; i < chords; ++i) {
      const double t = static_cast<double>(i) / chords;
      points.push_back(
          {static_cast<float>(cubic(a.x, b.x, c.x, d.x, t)), static_cast<float>(cubic(a.y, b.y, c.y, d.y, t))});
    }
    points.push_back(d);
  }
  return smooth_curve(std::move(points));
}

}  // namespace

PropertyType bezier_property() {
  return {
      {"Bezier",
       "Bezier",
       "A smooth curve of cubic Bézier pieces: control points of which every third lies on the curve; x must not fall.",
       {},
       {{"TablePoint", 4, -1}},
       config::ValueType::none,
       true,
       "<Bezier><point x=\"0\" y=\"0\"/><point x=\"0.3\" y=\"0\"/><point x=\"0.7\" y=\"1\"/><point x=\"1\" "
       "y=\"1\"/></Bezier>"},
      make};
}

}  // namespace silvasim::evaluators
