// Density fields: functions of a place that say how dense details of a type are there, worked out from skeletal primitives and
// operators (the BlobTree), over the ground and over what stands on it.
//
// A Field is a tree in scene coordinates and doubles. It is cut down to what matters in a box, again and again while the box is
// halved, and what is left is compiled for blocks of points in floats relative to a corner near by: so values depend on the place
// and the corner alone, never on how large a land is filled, and a point costs nothing for primitives that are far.
//
// Units: metres, scene coordinates (x east, y north, z up). Values: 0 outside, above 0 inside, usually up to 1.
// No data: where a sampled plane has none, its value is 0.
// Threads: immutable; everything const may be called from any number of threads, evaluate() with a Scratch each.
// Source: Guérin et al. 2016, section 5; Wyvill, Guy and Galin 1999 (BlobTree).
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "assets/vector.h"

namespace ghosttile::density {

using assets::V3;
using assets::V3d;

// A closed, axis-parallel box; empty where least > most.
struct Box3 {
  V3d least{0, 0, 0}, most{0, 0, 0};
};

// All values that a function takes somewhere, and maybe more.
struct Range {
  float least = 0, most = 0;
};

// Most points in one block.
inline constexpr std::size_t block_size = 256;

// Columns of at most block_size points, relative to the compiled field's corner.
struct Points {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  std::size_t count = 0;
};

// A function of the plane, sampled: the ground's height, the cover of crowns, a response to a data field.
// One call a block, never a point.
class Plane {
 public:
  virtual ~Plane() = default;
  // value[i] at (origin.x + x[i], origin.y + y[i]); a pure function of the place.
  virtual void sample(const V3d& origin, const float* x, const float* y, std::size_t count, float* value) const = 0;
  // Everything that sample() may return within the rectangle [least, most].
  virtual Range bounds(double west, double south, double east, double north) const = 0;
};

struct Node;  // node.h: the tree's nodes as plain values

// Room that evaluate() works in. Grows once, then is used again.
struct Scratch {
  std::vector<float> columns;
};

struct Program;  // program.h: what is left of a field as a list of steps
struct Cut;      // tree.h: what is left of a tree, on the tree's worked-out primitives

// A field made ready for points near a corner. Holds on to the planes that it samples.
class Compiled {
 public:
  Range range;  // within the box that it was cut down to
  bool empty() const { return !(range.most > 0); }
  bool constant() const { return range.least == range.most; }

  // value[i] at points[i], which lie in the box that the field was cut down to. Never NaN, never below 0.
  void evaluate(const Points& points, Scratch& scratch, float* value) const;

 private:
  friend class Field;
  std::shared_ptr<const Program> program_;  // none: constant
};

// A corner is near by when it is no farther from the box than 32 of the box's diagonals.
class Field {
 public:
  Field() = default;  // 0 everywhere
  // base::Error with problem_with(tree) where there is one.
  explicit Field(Node tree);

  // 0 everywhere for certain; after within(), in the box.
  bool empty() const { return !cut_; }
  // Outside of it the field is 0 for certain. May be unbounded (+-infinity).
  Box3 bounds() const;
  Range range(const Box3& box) const;
  // What of it matters within the box: the same values there, to the bit, when compiled with the same corner near by.
  Field within(const Box3& box) const;
  Compiled compiled(const V3d& corner, const Box3& box) const;

 private:
  std::shared_ptr<const Cut> cut_;  // none: 0 everywhere
};

}  // namespace ghosttile::density
