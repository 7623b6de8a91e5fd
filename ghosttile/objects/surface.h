// A model's surface made ready for fitting: which parts of it enclose a volume, how far it is, what lies inside.
//
// Shape: columns by triangle. A part (triangles joined by common corners) is solid where every edge is run through once in each
//   direction and they are no thin sheet; all else is a shell: leaf cards, blades, thin sheets, surfaces with a hole.
// Units: metres. Promise: normals of solid triangles point outward, whatever the file's order of corners.
// Errors: base::Error naming the model: no triangle, no area, a number that is not finite, an index out of range, too many.
// Threads: immutable once made. Cost: making it n log n; inside() about 50 ns; distance() a comparison a triangle.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "assets/model.h"

namespace ghosttile::objects {

using assets::V3;
using assets::V3d;

inline constexpr std::size_t most_triangles = 1'000'000;  // of one detail

struct Surface {
  std::vector<std::array<V3d, 3>> corners;
  std::vector<V3d> normals;
  std::vector<double> area_m2;
  std::vector<std::uint8_t> solid;   // of a closed part
  std::vector<std::uint8_t> buried;  // lies wholly within the union of closed parts: nobody sees it
  std::vector<V3d> middle;           // of the circle about the triangle
  std::vector<double> reach_m;
  V3d least{0, 0, 0}, most{0, 0, 0};
  double volume_m3 = 0;  // of the solid parts, overlaps counted twice
  double radius_m = 0;   // half the bounding box's diagonal

  // Triangles by column of a grid over x and y, for inside().
  int columns = 1;
  std::vector<std::uint32_t> first, members;
};

// `sheets`: closed parts that are at least so many times as wide as thick count as shells too.
Surface surface_of(const assets::Model& model, double sheets = 25);

// Within a solid part: signed crossings of the ray upward; no ray slips through an edge.
bool inside(const Surface& surface, const V3d& point);

// To the nearest point of the triangles that are not buried, of those with `solid` as given or of all (-1); `at_most` where
// none is nearer.
double distance_m(const Surface& surface, const V3d& point, double at_most, int solid = -1);

struct Samples {
  std::vector<V3d> points, normals;
};

enum class Part { all, solid, shell };

// `count` points spread by area over the part's triangles that are not buried, one in each of as many equal shares of the area.
// `use` names the stream of random numbers. Empty where the part has no area.
Samples sample(const Surface& surface, Part part, std::size_t count, std::uint64_t seed, std::uint32_t use);

double area_of(const Surface& surface, Part part);

}  // namespace ghosttile::objects
