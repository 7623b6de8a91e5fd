// The tree of a density field as plain values: what the XML says, before it is worked out. See field.h.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ghosttile/density/field.h"

namespace ghosttile::density {

enum class Kind : std::uint8_t {
  // Skeletal primitives: the value falls from 1 at the skeleton's core to 0 at `radius_m` from the skeleton.
  constant,  // `value` everywhere
  point,     // points[0]
  segment,   // points[0] to points[1]
  curve,     // the polyline through `points`
  disc,      // centre points[0], upright normal unless `axis` is given, `size.x` its radius
  box,       // centre points[0], half sides `size`, turned by `turn_deg` about z
  cylinder,  // axis points[0] to points[1], `size.x` its radius; solid
  sphere,    // centre points[0], `size.x` its radius; solid
  layer,     // between `from_m` and `to_m` above `plane` (a height)
  above,     // 1 above `plane` + `from_m`, 0 below: what lies in the ground is cut off with it
  column,    // `plane` itself as a value, whatever the height: a rule's response
  // Operators over `children`
  blend,      // the sum, at most 1
  unite,      // the greatest
  intersect,  // the least
  differ,     // the first less all others: min(first, 1 - other)
  multiply,   // the product: a shape times a response
  scale,      // the only child times `value`
  warp,  // the only child at a place moved by noise: `size.x` how far at most along each axis, `radius_m` the noise's
         // wavelength; shapes fold over where `size.x` is above about a quarter of it
};

struct Node {
  Kind kind = Kind::constant;
  float value = 1;
  std::vector<V3d> points;
  V3d size{0, 0, 0}, axis{0, 0, 1};
  double radius_m = 0;  // of the falloff, from the skeleton or the solid's surface outward
  double core = 0;      // share of radius_m within which the value is 1
  double from_m = 0, to_m = 0;
  double turn_deg = 0;
  std::uint64_t seed = 0;  // of a warp
  std::shared_ptr<const Plane> plane;
  std::vector<Node> children;
};

// What is wrong with a tree, in words that name the kind and say what would be right; empty where nothing is.
std::string problem_with(const Node& tree);

// The name of a kind, as above.
const char* name_of(Kind kind);

}  // namespace ghosttile::density
