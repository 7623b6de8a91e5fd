#include <algorithm>
#include <cmath>

#include "ghosttile/objects/surface.h"
#include "silvasim/base/random.h"

namespace ghosttile::objects {

namespace {

// On which side of a line a point lies, seen from above: the same answer, with the other sign, for the line run backward.
// Points on the line belong to one side, as if every point were moved by an endless little.
int side(const V3d& from, const V3d& to, const V3d& p) {
  const bool forward = from.x != to.x ? from.x < to.x : from.y < to.y;
  const V3d& a = forward ? from : to;
  const V3d& b = forward ? to : from;
  const int left = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) >= 0 ? 1 : -1;
  return forward ? left : -left;
}

// Squared distance to a triangle, by the region that the point's foot lies in (Ericson 2005, section 5.1.5).
double squared_distance(const std::array<V3d, 3>& corners, const V3d& p) {
  const auto& [a, b, c] = corners;
  const V3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return ap.length2();
  const V3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return bp.length2();
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return (ap - ab * (d1 / (d1 - d3))).length2();
  const V3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return cp.length2();
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return (ap - ac * (d2 / (d2 - d6))).length2();
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return (bp - (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)))).length2();
  const double sum = va + vb + vc;
  return (ap - ab * (vb / sum) - ac * (vc / sum)).length2();
}

bool belongs(const Surface& s, std::size_t t, Part part) {
  return !s.buried[t] && (part == Part::all || (part == Part::solid) == (s.solid[t] != 0));
}

}  // namespace

bool inside(const Surface& s, const V3d& p) {
  if (s.members.empty() || p.x < s.least.x || p.x > s.most.x || p.y < s.least.y || p.y > s.most.y) return false;
  const auto cell = [&](double at, double low, double high) {
    return std::clamp(static_cast<int>((high > low ? (at - low) / (high - low) : 0) * s.columns), 0, s.columns - 1);
  };
  const auto c = static_cast<std::size_t>(cell(p.y, s.least.y, s.most.y) * s.columns + cell(p.x, s.least.x, s.most.x));
  int winding = 0;
  for (std::uint32_t k = s.first[c]; k < s.first[c + 1]; ++k) {
    const auto& [a, b, d] = s.corners[s.members[k]];
    const int way = side(a, b, p);
    if (side(b, d, p) != way || side(d, a, p) != way) continue;
    const V3d& n = s.normals[s.members[k]];
    // Above the point: on the side of the plane that is below it.
    const double height = n.dot(p - a);
    if ((way > 0 && height < 0) || (way < 0 && height > 0)) winding += way;
  }
  return winding > 0;
}

double distance_m(const Surface& s, const V3d& p, double at_most, int solid) {
  double best = at_most, squared = at_most * at_most;
  for (std::size_t t = 0; t < s.corners.size(); ++t) {
    const double far = best + s.reach_m[t];
    if ((p - s.middle[t]).length2() >= far * far || s.buried[t] || (solid >= 0 && s.solid[t] != solid)) continue;
    const double d = squared_distance(s.corners[t], p);
    if (d < squared) {
      squared = d;
      best = std::sqrt(d);
    }
  }
  return best;
}

double area_of(const Surface& s, Part part) {
  double sum = 0;
  for (std::size_t t = 0; t < s.corners.size(); ++t) sum += belongs(s, t, part) ? s.area_m2[t] : 0;
  return sum;
}

Samples sample(const Surface& s, Part part, std::size_t count, std::uint64_t seed, std::uint32_t use) {
  Samples samples;
  const double area = area_of(s, part);
  if (!(area > 0)) return samples;
  double passed = 0;
  std::size_t t = 0, last = 0;
  for (std::size_t i = 0; i < count; ++i) {
    silvasim::base::Stream draws(seed, silvasim::base::Purpose::detail_surface, use, static_cast<std::uint32_t>(i));
    const double at = (static_cast<double>(i) + draws.next_double()) / static_cast<double>(count) * area;
    for (; t < s.corners.size(); ++t) {
      if (!belongs(s, t, part)) continue;
      last = t;
      if (passed + s.area_m2[t] > at) break;
      passed += s.area_m2[t];
    }
    const std::size_t k = t < s.corners.size() ? t : last;
    const double u = std::sqrt(draws.next_double()), v = draws.next_double();
    const auto& [a, b, c] = s.corners[k];
    samples.points.push_back(a * (1 - u) + b * (u * (1 - v)) + c * (u * v));
    samples.normals.push_back(s.normals[k]);
  }
  return samples;
}

}  // namespace ghosttile::objects
