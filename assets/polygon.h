// Polygons with any number of corners, convex or not, cut into triangles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "assets/vector.h"

namespace assets {

// Cuts ears off in the plane that Newell's normal tells. A polygon that crosses itself still gives its n - 2 triangles.
// The work on one file is bounded: beyond, what is left is cut as a fan.
class Triangulator {
 public:
  // Calls nothing; appends triples of corner numbers to `out`, in the polygon's own sense.
  void cut(std::span<const V3> corners, std::vector<std::array<std::uint32_t, 3>>& out);

  bool gave_up() const { return work_left_ == 0; }

 private:
  std::size_t work_left_ = 100'000'000;  // tests of a corner against an ear: some seconds
};

}  // namespace assets
