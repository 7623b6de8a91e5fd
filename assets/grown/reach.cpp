#include "assets/grown/reach.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace assets::grown {

namespace {

// Which of 32 sectors around the axis; three bits by comparisons, two by slopes, because no arctangent is needed.
std::size_t sector_of(const V3& p, float reach) {
  const float x = std::abs(p.x), y = std::abs(p.y);
  const float share = reach > 0 ? std::min(x, y) / reach : 0;  // sine of the angle within the octant
  const std::size_t within = share < 0.19509f ? 0 : share < 0.38268f ? 1 : share < 0.55557f ? 2 : 3;
  return (p.x < 0 ? 16u : 0u) + (p.y < 0 ? 8u : 0u) + (x < y ? 4u : 0u) + within;
}

}  // namespace

void fit_points(std::vector<V3>& points, float height_m, float radius_m) {
  constexpr std::size_t sectors = 32;
  std::array<float, sectors> farthest{};
  float highest = 0;
  const auto reach_of = [](const V3& p) { return std::sqrt(p.x * p.x + p.y * p.y); };
  for (const V3& p : points) {
    highest = std::max(highest, p.z);
    const float r = reach_of(p);
    float& most = farthest[sector_of(p, r)];
    most = std::max(most, r);
  }
  std::sort(farthest.begin(), farthest.end());
  // A third of the directions may reach less far than usual.
  const float usual = std::max(farthest[sectors / 3], 1e-6f);
  // Beyond the usual reach lengths grow ever slower, to a sixth more at most.
  const auto drawn_in = [&](float r) {
    const float over = r / usual - 1;
    return over <= 0 ? 1.0f : (1 + over / (1 + 6 * over)) / (1 + over);
  };
  float widest = 0;
  for (V3& p : points) {
    const float s = drawn_in(reach_of(p));
    p = V3(p.x * s, p.y * s, p.z);
    widest = std::max(widest, reach_of(p));
  }
  if (widest <= 0 || highest <= 0) return;
  const float wide = radius_m / widest, high = height_m / highest;
  for (V3& p : points) p = V3(p.x * wide, p.y * wide, p.z > 0 ? p.z * high : p.z);
}

}  // namespace assets::grown
