#include "ghosttile/cover/response_range.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace ghosttile::cover {

namespace {

struct Control {
  double x, y;
};
using Piece = std::array<Control, 4>;

Control middle(const Control& a, const Control& b) { return {(a.x + b.x) / 2, (a.y + b.y) / 2}; }

// De Casteljau: `depth` halvings give 2^depth parts, in order.
template <typename Visit>
void cut(const Piece& p, int depth, Visit&& visit) {
  if (depth == 0) {
    visit(p);
    return;
  }
  const Control ab = middle(p[0], p[1]), bc = middle(p[1], p[2]), cd = middle(p[2], p[3]);
  const Control abc = middle(ab, bc), bcd = middle(bc, cd), top = middle(abc, bcd);
  cut({p[0], ab, abc, top}, depth - 1, visit);
  cut({top, bcd, cd, p[3]}, depth - 1, visit);
}

// An EvenCurve may be off by this much (piecewise.cpp), and the parts' ends by rounding.
constexpr float bezier_error = 2e-4f;
constexpr int bezier_halvings = 6;

float above(float x) { return std::nextafter(x, std::numeric_limits<float>::max()); }
float below(float x) { return std::nextafter(x, std::numeric_limits<float>::lowest()); }

}  // namespace

ResponseRange::ResponseRange(const silvasim::config::Node& node) {
  const std::string& type = node.rule->type;
  const auto corner = [&](const silvasim::config::Node& of, const char* name) {
    corners_.push_back(static_cast<float>(of.number(name)));
  };
  if (type == "MinMax") {
    corner(node, "min");
    corner(node, "max");
  } else if (type == "Gauss") {
    corner(node, "mean");
  } else if (type == "Trapezoid") {
    for (const char* name : {"a", "b", "c", "d"}) corner(node, name);
  } else if (type == "Table") {
    for (const auto* point : node.all("TablePoint")) corner(*point, "x");
  } else if (type == "Classes") {
    for (const auto* entry : node.all("ClassValue")) corner(*entry, "code");
  } else if (type == "Bezier") {
    const auto points = node.all("TablePoint");
    const auto control = [&](std::size_t i) { return Control{points[i]->number("x"), points[i]->number("y")}; };
    for (std::size_t k = 0; k + 3 < points.size(); k += 3) {
      cut({control(k), control(k + 1), control(k + 2), control(k + 3)}, bezier_halvings, [&](const Piece& p) {
        const auto [low, high] = std::minmax({p[0].y, p[1].y, p[2].y, p[3].y});
        const double hair = 1e-5 * (std::fabs(p[0].x) + std::fabs(p[3].x));
        parts_.push_back({static_cast<float>(p[0].x - hair),
                          static_cast<float>(p[3].x + hair),
                          {static_cast<float>(low) - bezier_error, static_cast<float>(high) + bezier_error}});
      });
    }
  }
  std::sort(corners_.begin(), corners_.end());
}

Range ResponseRange::of(const silvasim::evaluators::Response& response, const Range& values) const {
  constexpr float most = 1e30f;  // responses are compiled without infinities
  const Range x{std::clamp(values.least, -most, most), std::clamp(values.most, -most, most)};
  Range y{std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest()};
  const auto ask = [&](float at) {
    if (at < x.least || at > x.most) return;
    float answer = 0;
    response.apply(&at, &answer, 1);
    y = {std::min(y.least, answer), std::max(y.most, answer)};
  };
  ask(x.least);
  if (x.least == x.most) return y;
  ask(x.most);
  // At a corner there may be a step to either side.
  for (const float corner : corners_) {
    ask(below(corner));
    ask(corner);
    ask(above(corner));
  }
  for (const Part& part : parts_) {
    if (part.last_x < x.least || part.first_x > x.most) continue;
    y = {std::min(y.least, part.y.least), std::max(y.most, part.y.most)};
  }
  // Rounding along a straight or a bell's flank; where all are 0, the flank is 0 itself.
  constexpr float hair = 1e-6f;
  if (y.least == y.most && (y.most == 0 || y.most == 1) && parts_.empty()) return y;
  return {std::max(0.0f, y.least - hair), y.most > 0 ? std::min(1.0f, y.most + hair) : 0.0f};
}

}  // namespace ghosttile::cover
