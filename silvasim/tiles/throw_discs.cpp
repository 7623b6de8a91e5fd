#include "silvasim/tiles/throw_discs.h"

#include <cmath>

namespace silvasim::tiles {

namespace {

// A coordinate as the float that will be written in the frame of the tile it lies in, carried back to this frame.
// Lies that tile's float at or beyond its side, NaN: the dart is to be thrown again.
double rounded(double x, double side) {
  const double shift = x < 0 ? -side : (x >= side ? side : 0.0);
  const double in_tile = static_cast<double>(static_cast<float>(x - shift));
  return in_tile >= 0 && in_tile < side ? in_tile + shift : std::nan("");
}

}  // namespace

DiscGrid grid_for(const base::Box& window, double most_radius_m, double sites_per_m2) {
  return {window, most_radius_m, 1e-6 * most_radius_m, 1.5 / std::sqrt(sites_per_m2)};
}

std::vector<Disc> throw_discs(DiscGrid& grid, const Region& region, const Radii& radii, const Throwing& throwing,
                              base::Stream& random) {
  std::vector<Disc> thrown;
  if (region.area_m2() <= 0) return thrown;
  // Round the number of discs at random, so that many small regions together have the asked density.
  const double wanted = throwing.sites_per_m2 * region.area_m2() + random.next_double();
  const std::size_t count = static_cast<std::size_t>(wanted);
  thrown.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double share = (static_cast<double>(i) + random.next_double()) / static_cast<double>(count);
    const double radius = static_cast<double>(radii.quantile(1 - share));
    for (int attempt = 0; attempt < throwing.most_tries; ++attempt) {
      const base::Point point = region.draw(random);
      const Disc disc{rounded(point.x, throwing.side_m), rounded(point.y, throwing.side_m), radius};
      // Rounding may carry a dart over the region's rim; NaN is contained nowhere.
      if (!region.contains({disc.x, disc.y}) || !grid.fits(disc)) continue;
      grid.add(disc);
      thrown.push_back(disc);
      break;
    }
  }
  return thrown;
}

}  // namespace silvasim::tiles
