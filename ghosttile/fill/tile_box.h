// Places and boxes of tiles. Tile (x, y, z) is the cube from (x, y, z) * side in scene coordinates.
#pragma once

#include <algorithm>
#include <cstdint>

namespace ghosttile::fill {

// In the order of columns: by y, x, z.
struct TilePlace {
  std::int32_t x = 0, y = 0, z = 0;

  friend bool operator==(const TilePlace&, const TilePlace&) = default;
  friend bool operator<(const TilePlace& a, const TilePlace& b) {
    return a.y != b.y ? a.y < b.y : a.x != b.x ? a.x < b.x : a.z < b.z;
  }
};

// Tiles [x0, x1) x [y0, y1) x [z0, z1).
struct TileBox {
  int x0 = 0, y0 = 0, z0 = 0, x1 = 0, y1 = 0, z1 = 0;

  bool empty() const { return x0 >= x1 || y0 >= y1 || z0 >= z1; }
  bool holds(int x, int y, int z) const { return x >= x0 && x < x1 && y >= y0 && y < y1 && z >= z0 && z < z1; }
  friend bool operator==(const TileBox&, const TileBox&) = default;
};

inline TileBox intersection(const TileBox& a, const TileBox& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::max(a.z0, b.z0),
          std::min(a.x1, b.x1), std::min(a.y1, b.y1), std::min(a.z1, b.z1)};
}
inline TileBox grown(const TileBox& box, int by) {
  return {box.x0 - by, box.y0 - by, box.z0 - by, box.x1 + by, box.y1 + by, box.z1 + by};
}

}  // namespace ghosttile::fill
