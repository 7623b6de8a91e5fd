#include "ghosttile/objects/anchors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ghosttile/objects/surface.h"
#include "silvasim/base/error.h"
#include "silvasim/base/random.h"

namespace ghosttile::objects {

namespace {

constexpr std::uint32_t use_anchor = 2;

V3 to_float(const V3d& p) { return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)}; }

V3d centre(const Surface& s) {
  V3d sum(0, 0, 0);
  double weight = 0;
  const bool solid = s.volume_m3 > 0;
  const V3d origin = (s.least + s.most) * 0.5;
  for (std::size_t t = 0; t < s.corners.size(); ++t) {
    const V3d a = s.corners[t][0] - origin, b = s.corners[t][1] - origin, c = s.corners[t][2] - origin;
    if (solid && !s.solid[t]) continue;
    // Of a solid: tetrahedra from the origin, with their signs.
    const double w = solid ? a.dot(b.cross(c)) / 6 : s.area_m2[t];
    sum += (a + b + c) * (w / (solid ? 4 : 3));
    weight += w;
  }
  return origin + sum / weight;
}

// Points within the volume, by trying places in the bounding box.
std::vector<V3d> within(const Surface& s, std::size_t count, std::uint64_t seed) {
  std::vector<V3d> points;
  if (!(s.volume_m3 > 0)) return points;
  const V3d size = s.most - s.least;
  for (std::uint32_t i = 0; i < 400'000 && points.size() < count; ++i) {
    silvasim::base::Stream draws(seed, silvasim::base::Purpose::detail_anchor, i);
    const double u = draws.next_double(), v = draws.next_double(), w = draws.next_double();
    const V3d p = s.least + V3d(u * size.x, v * size.y, w * size.z);
    if (inside(s, p)) points.push_back(p);
  }
  return points;
}

std::vector<V3> spread(const std::vector<V3d>& points, const V3d& first, std::size_t count) {
  std::vector<double> far(points.size(), std::numeric_limits<double>::infinity());
  // The first is the one nearest to the middle.
  std::size_t next = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if ((points[i] - first).length2() < (points[next] - first).length2()) next = i;
  }
  std::vector<V3> result;
  while (result.size() < std::min(count, points.size())) {
    result.push_back(to_float(points[next]));
    for (std::size_t i = 0; i < points.size(); ++i) far[i] = std::min(far[i], (points[i] - points[next]).length2());
    next = static_cast<std::size_t>(std::max_element(far.begin(), far.end()) - far.begin());
  }
  return result;
}

}  // namespace

V3 centre_of(const assets::Model& model) { return to_float(centre(surface_of(model))); }

V3 foot_of(const assets::Model& model) {
  const Surface s = surface_of(model);
  V3d low(s.most), high(s.least);
  for (const auto& corners : s.corners) {
    for (const V3d& p : corners) {
      if (p.z > s.least.z + 1e-6 * s.radius_m) continue;
      low = {std::min(low.x, p.x), std::min(low.y, p.y), s.least.z};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), s.least.z};
    }
  }
  return to_float((low + high) * 0.5);
}

std::vector<V3> anchors_of(const assets::Model& model, const AnchorOptions& options) {
  const auto fail = [&](const std::string& what) {
    throw silvasim::base::Error(fmt::format("detail \"{}\": {}", model.name, what));
  };
  switch (options.places) {
    case AnchorPlaces::origin:
      return {V3(0, 0, 0)};
    case AnchorPlaces::centre:
      return {centre_of(model)};
    case AnchorPlaces::foot:
      return {foot_of(model)};
    case AnchorPlaces::given:
      if (options.given.empty()) fail("has no anchor; give one point at least");
      if (options.given.size() > static_cast<std::size_t>(most_anchors))
        fail("has more than " + std::to_string(most_anchors) + " anchors");
      for (const V3& p : options.given) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
          fail("has an anchor whose place is not a finite number");
      }
      return options.given;
    case AnchorPlaces::volume:
    case AnchorPlaces::surface:
      break;
  }
  if (options.count < 1 || options.count > most_anchors)
    fail(fmt::format("{} anchors were asked for; 1 to {} are possible", options.count, most_anchors));
  const auto count = static_cast<std::size_t>(options.count);
  const Surface s = surface_of(model);
  std::vector<V3d> points;
  if (options.places == AnchorPlaces::volume) points = within(s, 32 * count, options.seed);
  if (points.size() < count) points = sample(s, Part::all, 32 * count, options.seed, use_anchor).points;
  return spread(points, centre(s), count);
}

}  // namespace ghosttile::objects
