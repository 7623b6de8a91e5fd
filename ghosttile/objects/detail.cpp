#include "ghosttile/objects/detail.h"

#include <algorithm>

namespace ghosttile::objects {

float reach_of(const std::vector<Sphere>& spheres) {
  float most = 0;
  for (const Sphere& sphere : spheres) most = std::max(most, sphere.centre.length() + sphere.radius_m);
  return most;
}

}  // namespace ghosttile::objects
