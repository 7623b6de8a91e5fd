// A density field's tree, worked out once: its primitives in one column, and its shape as a flat list that is cut down quickly.
//
// Shape: a Cut's items stand in prefix order, an operator before its children; `span` steps over a whole subtree. All cuts
//   of one field share the Tree. A curve is the greatest of its segments, which is the same: the falloff never rises.
// Units: metres, scene coordinates.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "ghosttile/density/node.h"

namespace ghosttile::density {

// Distances that are worked out in floats relative to a corner near by differ from the true ones by less than this share of
// the lengths that take part, by far: what is farther than that from a rim is certain to be on its side of it.
inline constexpr double slack = 0x1p-15;

struct Leaf {
  Kind kind = Kind::point;
  std::uint32_t plane = 0;  // into Tree::planes
  V3d at{0, 0, 0};          // a start or a centre
  V3d axis{0, 0, 1};        // of unit length
  double length_m = 0;      // along the axis
  V3d half{0, 0, 0};
  double cos_turn = 1, sin_turn = 0;
  double size_m = 0;  // the solid's or the disc's radius
  double radius_m = 0, core = 0;
  double from_m = 0, to_m = 0;
  double reach_m = 0;  // the lengths of it that slack is a share of
  Box3 bounds;         // outside it is 0

  // 1 or 0, nothing between: the falloff is thinner than a thousandth of a millimetre.
  bool sharp() const { return !(radius_m * (1 - core) > 1e-6); }
};

struct Warp {
  double far_m = 0, wavelength_m = 1;
  std::uint32_t key = 0;
};

struct Tree {
  std::vector<Leaf> leaves;
  std::vector<Warp> warps;
  std::vector<std::shared_ptr<const Plane>> planes;
};

struct Item {
  Kind kind = Kind::constant;
  std::uint32_t index = 0;  // of a leaf or a warp
  std::uint32_t span = 1;   // items of the subtree, this one among them
  float value = 0;          // of a constant or a scale
};

struct Cut {
  std::shared_ptr<const Tree> tree;
  std::vector<Item> items;
};

inline bool is_operator(Kind kind) { return kind >= Kind::blend; }

// Precondition: problem_with(node) is empty.
Cut worked_out(const Node& node);

// What matters of items[0] within the box is appended to `out`; returns its range there.
Range cut_down(const Tree& tree, const std::vector<Item>& items, const Box3& box, std::vector<Item>& out);

Box3 bounds_of(const Tree& tree, const std::vector<Item>& items);

}  // namespace ghosttile::density
