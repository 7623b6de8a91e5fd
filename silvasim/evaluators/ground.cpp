#include "silvasim/evaluators/ground.h"

namespace silvasim::evaluators {

std::optional<SitePlace> nearest_site(const Ground& ground, base::Point at) {
  std::optional<SitePlace> best;
  double least = 0;
  for_sites_around(ground, at, ground.tile_set.side_m, [&](const SitePlace& site) {
    const double distance = std::hypot(site.at.x - at.x, site.at.y - at.y);
    if (best && distance >= least) return;
    least = distance;
    best = site;
  });
  return best;
}

}  // namespace silvasim::evaluators
