#include "ghosttile/config/density_xml.h"

#include <algorithm>
#include <cmath>

#include "assets/grown/draws.h"
#include "ghosttile/config/dialect.h"
#include "ghosttile/cover/rule_xml.h"
#include "ghosttile/cover/trunks.h"
#include "ghosttile/density/ground_plane.h"
#include "silvasim/base/random.h"

namespace ghosttile::config {

using density::Kind;
using density::Node;
using density::V3d;
using silvasim::base::add;

namespace {

bool is_density(const xml::Node& node) {
  return std::ranges::find(density_types(), node.rule->type) != density_types().end();
}

// A place about the surroundings' origin, turned as they are.
V3d turned(const Surroundings& around, const V3d& v) {
  const assets::grown::SinCos turn =
      assets::grown::sin_cos(assets::grown::radians(static_cast<float>(around.turn_deg)));
  const auto c = static_cast<double>(turn.cos), s = static_cast<double>(turn.sin);
  return {around.origin.x + c * v.x - s * v.y, around.origin.y + s * v.x + c * v.y, v.z};
}

// A place in the land's coordinates.
V3d land_place(const xml::Node& node, const std::string& attribute, const Surroundings& around, Errors& errors) {
  V3d at = turned(around, place(node, attribute, errors));
  if (around.above_ground && around.ground) at.z += height_at(*around.ground, at.x, at.y);
  return at;
}

Node with_falloff(Kind kind, const xml::Node& node) {
  Node made;
  made.kind = kind;
  if (node.knows("radius")) made.radius_m = node.number("radius");
  if (node.knows("core")) made.core = node.number("core");
  return made;
}

Node primitive(const xml::Node& node, const Surroundings& around, Errors& errors) {
  const std::string& type = node.rule->type;
  const auto at = [&](const std::string& attribute) { return land_place(node, attribute, around, errors); };
  if (type == "Everywhere") {
    Node made;
    made.value = static_cast<float>(node.number("value"));
    return made;
  }
  if (type == "GroundLayer") {
    Node made = with_falloff(Kind::layer, node);
    made.from_m = node.number("from");
    made.to_m = node.number("to");
    if (made.from_m > made.to_m) add(errors, node.place, "<layer>: from is above to");
    made.plane = around.ground ? around.ground : density::flat_plane(0);
    return made;
  }
  if (type == "Curve") {
    Node made = with_falloff(Kind::curve, node);
    for (const xml::Node* corner : node.all("CurvePoint"))
      made.points.push_back(land_place(*corner, "at", around, errors));
    return made;
  }
  if (type == "Segment" || type == "Cylinder") {
    Node made = with_falloff(type == "Segment" ? Kind::segment : Kind::cylinder, node);
    made.points = {at("from"), at("to")};
    if (type == "Cylinder") made.size.x = node.number("size");
    return made;
  }
  Node made = with_falloff(type == "Point"  ? Kind::point
                           : type == "Disc" ? Kind::disc
                           : type == "Box"  ? Kind::box
                                            : Kind::sphere,
                           node);
  made.points = {at("at")};
  if (type == "Disc" || type == "Ball") made.size.x = node.number("size");
  if (type == "Box") {
    const std::vector<double> sides = numbers(node, "size", 3, 3, errors);
    for (const double side : sides)
      if (side < 0) add(errors, node.place_of("size"), "size: a side is below 0");
    made.size = V3d(sides[0], sides[1], sides[2]) * 0.5;
    made.turn_deg = node.number("turn") + around.turn_deg;
  }
  return made;
}

Node trunks(const xml::Node& node, const Surroundings& around, Errors& errors) {
  Node made;
  made.kind = Kind::unite;
  if (!around.land) {
    add(errors, node.place, "<trunks> asks for an ecosystem; name one by <ecosystem>");
    return made;
  }
  cover::TrunkOptions options;
  options.gap_m = static_cast<float>(node.number("gap"));
  made.children = cover::trunks(cover::chosen_by(node, *around.land, errors), around.region, options);
  if (made.children.empty()) {
    made = Node();
    made.value = 0;
  }
  return made;
}

std::vector<Node> children_of(const xml::Node& node, const Surroundings& around, Errors& errors) {
  std::vector<Node> children;
  for (const xml::Node& child : node.children)
    if (is_density(child)) children.push_back(density_of(child, around, errors));
  if (children.empty()) {
    add(errors, node.place,
        "<" + node.rule->tag + "> holds no density element; put a <layer>, <sphere> or the like into it");
    children.emplace_back();
  }
  return children;
}

// Copies at chance places, each at least `apart` from those before; fewer where there is no room.
Node scatter(const xml::Node& node, const Surroundings& around, Errors& errors) {
  Node made;
  made.kind = Kind::unite;
  const std::vector<double> box = numbers(node, "box", 4, 4, errors);
  if (box[0] > box[2] || box[1] > box[3])
    add(errors, node.place_of("box"), "box: west should be below east, and south below north");
  const auto count = static_cast<std::size_t>(node.number("count"));
  const double apart = node.has("apart") ? node.number("apart") : 0;
  silvasim::base::Stream stream(static_cast<std::uint64_t>(node.number("seed")), silvasim::base::Purpose::scatter);
  std::vector<V3d> places;
  for (std::size_t tried = 0; tried < 30 * count && places.size() < count; ++tried) {
    const double x = box[0] + (box[2] - box[0]) * stream.next_double(),
                 y = box[1] + (box[3] - box[1]) * stream.next_double(), turn = 360 * stream.next_double();
    const V3d at(x, y, turn);
    if (std::ranges::any_of(places,
                            [&](const V3d& other) { return std::hypot(at.x - other.x, at.y - other.y) < apart; }))
      continue;
    places.push_back(at);
  }
  for (const V3d& at : places) {
    Surroundings there = around;
    there.origin = turned(around, V3d(at.x, at.y, 0));
    there.turn_deg = around.turn_deg + at.z;
    std::vector<Node> copies = children_of(node, there, errors);
    std::ranges::move(copies, std::back_inserter(made.children));
    if (!errors.empty()) break;
  }
  return made;
}

Node operation(Kind kind, const xml::Node& node, const Surroundings& around, Errors& errors) {
  Node made;
  made.kind = kind;
  made.children = children_of(node, around, errors);
  if ((kind == Kind::scale || kind == Kind::warp) && made.children.size() > 1) {
    Node all;
    all.kind = Kind::unite;
    all.children = std::move(made.children);
    made.children = {std::move(all)};
  }
  return made;
}

}  // namespace

double height_at(const density::Plane& ground, double x, double y) {
  const float zero = 0;
  float height = 0;
  ground.sample({x, y, 0}, &zero, &zero, 1, &height);
  return static_cast<double>(height);
}

Node density_of(const xml::Node& element, const Surroundings& around, Errors& errors) {
  const std::string& type = element.rule->type;
  if (type == "Trunks") return trunks(element, around, errors);
  if (type == "Scatter") return scatter(element, around, errors);
  if (type == "Blend") return operation(Kind::blend, element, around, errors);
  if (type == "Union") return operation(Kind::unite, element, around, errors);
  if (type == "Intersection") return operation(Kind::intersect, element, around, errors);
  if (type == "Difference") return operation(Kind::differ, element, around, errors);
  if (type == "Multiply") return operation(Kind::multiply, element, around, errors);
  if (type == "Scaled") {
    Node made = operation(Kind::scale, element, around, errors);
    made.value = static_cast<float>(element.number("value"));
    return made;
  }
  if (type == "Warp") {
    Node made = operation(Kind::warp, element, around, errors);
    made.size.x = element.number("distance");
    made.radius_m = element.number("wavelength");
    made.seed = static_cast<std::uint64_t>(element.number("seed"));
    return made;
  }
  if (type == "Where") {
    Node made;
    made.kind = Kind::column;
    if (around.land) {
      made.plane = cover::make_rule(element, *around.land, errors);
    } else {
      add(errors, element.place, "<where> asks for an ecosystem; name one by <ecosystem>");
    }
    if (!made.plane) made.plane = density::flat_plane(0);
    return made;
  }
  return primitive(element, around, errors);
}

Node product_of(const xml::Node& holder, double value, const Surroundings& around, Errors& errors) {
  std::vector<Node> factors = children_of(holder, around, errors);
  Node product;
  if (factors.size() == 1) {
    product = std::move(factors[0]);
  } else {
    product.kind = Kind::multiply;
    product.children = std::move(factors);
  }
  if (value == 1) return product;
  Node scaled;
  scaled.kind = Kind::scale;
  scaled.value = static_cast<float>(value);
  scaled.children = {std::move(product)};
  return scaled;
}

}  // namespace ghosttile::config
