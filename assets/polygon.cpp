#include "assets/polygon.h"

#include <cmath>
#include <numeric>

namespace assets {

namespace {

struct Flat {
  double x, y;
};

double cross(const Flat& a, const Flat& b, const Flat& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Drops the axis along which Newell's normal is longest, and keeps the polygon anticlockwise.
std::vector<Flat> flattened(std::span<const V3> corners) {
  double nx = 0, ny = 0, nz = 0;
  const V3d middle(corners[0]);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const V3d a = V3d(corners[i]) - middle, b = V3d(corners[(i + 1) % corners.size()]) - middle;
    nx += (a.y - b.y) * (a.z + b.z);
    ny += (a.z - b.z) * (a.x + b.x);
    nz += (a.x - b.x) * (a.y + b.y);
  }
  const double ax = std::abs(nx), ay = std::abs(ny), az = std::abs(nz);
  std::vector<Flat> flat;
  flat.reserve(corners.size());
  for (const V3& corner : corners) {
    Flat p{};
    if (az >= ax && az >= ay) {
      p = {corner.x, nz < 0 ? -corner.y : corner.y};
    } else if (ax >= ay) {
      p = {corner.y, nx < 0 ? -corner.z : corner.z};
    } else {
      p = {corner.z, ny < 0 ? -corner.x : corner.x};
    }
    flat.push_back(p);
  }
  return flat;
}

bool inside(const Flat& p, const Flat& a, const Flat& b, const Flat& c) {
  return cross(a, b, p) >= 0 && cross(b, c, p) >= 0 && cross(c, a, p) >= 0;
}

bool same(const Flat& a, const Flat& b) { return a.x == b.x && a.y == b.y; }

}  // namespace

void Triangulator::cut(std::span<const V3> corners, std::vector<std::array<std::uint32_t, 3>>& out) {
  const std::size_t count = corners.size();
  if (count < 3) return;
  if (count == 3) {
    out.push_back({0, 1, 2});
    return;
  }
  const std::vector<Flat> flat = flattened(corners);
  std::vector<std::uint32_t> ring(count);
  std::iota(ring.begin(), ring.end(), 0u);

  // An ear is a convex corner whose triangle holds no other corner.
  const auto is_ear = [&](std::size_t at) {
    const Flat& a = flat[ring[(at + ring.size() - 1) % ring.size()]];
    const Flat& b = flat[ring[at]];
    const Flat& c = flat[ring[(at + 1) % ring.size()]];
    if (cross(a, b, c) <= 0) return false;
    for (const std::uint32_t other : ring) {
      if (work_left_ == 0) return true;
      --work_left_;
      const Flat& p = flat[other];
      // Corners may coincide with the ear's where a polygon with a hole is cut open along a bridge.
      if (!same(p, a) && !same(p, b) && !same(p, c) && inside(p, a, b, c)) return false;
    }
    return true;
  };

  std::size_t at = 0, misses = 0;
  while (ring.size() > 3) {
    at %= ring.size();
    // After a whole round without an ear (a polygon that crosses itself, or has no area) any corner must do.
    if (misses < ring.size() && work_left_ > 0 && !is_ear(at)) {
      ++at;
      ++misses;
      continue;
    }
    out.push_back({ring[(at + ring.size() - 1) % ring.size()], ring[at], ring[(at + 1) % ring.size()]});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(at));
    misses = 0;
  }
  out.push_back({ring[0], ring[1], ring[2]});
}

}  // namespace assets
