#include "ghosttile/objects/medial.h"

namespace ghosttile::objects {

std::vector<Ball> medial_balls(const Samples& samples, double largest_m) {
  const std::size_t count = samples.points.size();
  std::vector<double> x, y, z;
  for (const V3d& p : samples.points) {
    x.push_back(p.x);
    y.push_back(p.y);
    z.push_back(p.z);
  }
  std::vector<Ball> balls(count);
  std::vector<double> squared(count);
  for (std::size_t i = 0; i < count; ++i) {
    const V3d p = samples.points[i], n = samples.normals[i];
    double radius = largest_m;
    V3d centre = p - n * radius;
    for (int round = 0; round < 40; ++round) {
      for (std::size_t j = 0; j < count; ++j) {
        const double dx = x[j] - centre.x, dy = y[j] - centre.y, dz = z[j] - centre.z;
        squared[j] = dx * dx + dy * dy + dz * dz;
      }
      std::size_t nearest = i;
      double least = radius * radius * (1 - 1e-6);
      for (std::size_t j = 0; j < count; ++j) {
        if (squared[j] < least && j != i) {
          least = squared[j];
          nearest = j;
        }
      }
      if (nearest == i) break;
      // The ball through p and the nearest sample q with its centre on p's normal: r = |p - q|^2 / (2 n . (p - q)).
      const V3d off = p - samples.points[nearest];
      const double along = n.dot(off);
      if (!(along > 0)) break;
      radius = off.length2() / (2 * along);
      centre = p - n * radius;
    }
    balls[i] = {centre, radius};
  }
  return balls;
}

}  // namespace ghosttile::objects
