#include "ghosttile/density/node.h"

#include <array>
#include <cmath>

namespace ghosttile::density {

namespace {

constexpr int most_depth = 200;

// Farther than that squares of floats are not to be trusted.
constexpr double most_m = 1e8, most_value = 1e6;

bool finite(double x) { return std::abs(x) <= most_m; }
bool finite(const V3d& v) { return finite(v.x) && finite(v.y) && finite(v.z); }

std::string problem_with_numbers(const Node& node) {
  for (const V3d& point : node.points)
    if (!finite(point)) return "has a point that is not a number or too large; give metres up to 1e8";
  const std::array<double, 6> numbers{node.radius_m, node.core, node.from_m, node.to_m, node.turn_deg, node.value};
  for (const double number : numbers)
    if (!finite(number)) return "has a value that is not a number or too large; give values up to 1e8";
  if (!finite(node.size) || !finite(node.axis))
    return "has a size or axis that is not a number or too large; give metres up to 1e8";
  if (node.size.x < 0 || node.size.y < 0 || node.size.z < 0) return "has a size below 0; give 0 or more metres";
  if (node.radius_m < 0) return "has a radius_m below 0; give 0 or more metres";
  if (node.core < 0 || node.core > 1) return "has a core outside of 0 to 1; give the share of radius_m that is full";
  if (node.value < 0 || node.value > most_value) return "has a value outside of 0 to 1e6; densities are mostly up to 1";
  return {};
}

std::string problem_with_points(const Node& node) {
  const std::size_t count = node.points.size();
  switch (node.kind) {
    case Kind::point:
    case Kind::disc:
    case Kind::box:
    case Kind::sphere:
      if (count != 1) return "has " + std::to_string(count) + " points; give one";
      break;
    case Kind::segment:
    case Kind::cylinder:
      if (count != 2) return "has " + std::to_string(count) + " points; give two, its ends";
      break;
    case Kind::curve:
      if (count < 2) return "has " + std::to_string(count) + " points; give two or more";
      break;
    default:
      break;
  }
  return {};
}

std::string problem_with_kind(const Node& node) {
  switch (node.kind) {
    case Kind::disc:
      if (!(node.axis.length2() > 0)) return "has no axis; give a direction that is not 0";
      [[fallthrough]];
    case Kind::point:
    case Kind::segment:
    case Kind::curve:
      if (!(node.radius_m > 0)) return "has a radius_m of 0 and so no volume; give more than 0 metres";
      break;
    case Kind::layer:
      if (node.from_m > node.to_m) return "has from_m above to_m; give the lower one first";
      [[fallthrough]];
    case Kind::above:
    case Kind::column:
      if (!node.plane) return "has no plane; name the ground or a data field";
      break;
    case Kind::scale:
    case Kind::warp:
      if (node.children.size() != 1)
        return "has " + std::to_string(node.children.size()) + " children; give one field that it changes";
      if (node.kind == Kind::warp && !(node.radius_m >= 0.001))
        return "has a radius_m below a millimetre; give the noise's wavelength in metres";
      break;
    default:
      if (node.kind >= Kind::blend && node.children.empty()) return "has no children; give one field or more";
  }
  if (node.kind < Kind::blend && !node.children.empty()) return "has children; only operators may have some";
  return {};
}

std::string problem_at_depth(const Node& node, int depth) {
  if (depth > most_depth)
    return "the density tree is deeper than " + std::to_string(most_depth) + " operators; put children side by side";
  for (const auto check : {problem_with_numbers, problem_with_points, problem_with_kind}) {
    const std::string problem = check(node);
    if (!problem.empty()) return std::string("a ") + name_of(node.kind) + " " + problem;
  }
  for (const Node& child : node.children) {
    std::string problem = problem_at_depth(child, depth + 1);
    if (!problem.empty()) return problem;
  }
  return {};
}

}  // namespace

const char* name_of(Kind kind) {
  static constexpr std::array<const char*, 18> names{"constant", "point",     "segment", "curve",    "disc",   "box",
                                                     "cylinder", "sphere",    "layer",   "above",    "column", "blend",
                                                     "unite",    "intersect", "differ",  "multiply", "scale",  "warp"};
  return names[static_cast<std::size_t>(kind)];
}

std::string problem_with(const Node& tree) { return problem_at_depth(tree, 1); }

}  // namespace ghosttile::density
