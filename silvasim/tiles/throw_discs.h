// Dart throwing, largest disc first.
//
// The radii are cut into as many equal shares as there are discs to throw, one jittered radius a share: every disc is
// its own quota, so the accepted radii follow the asked distribution as closely as their number allows. A disc that
// finds no room within `most_tries` darts is left out. Promise: the darts depend on the stream and on what is in the
// grid only. Source: docs/reading.md, A5.
#pragma once

#include <vector>

#include "silvasim/base/random.h"
#include "silvasim/tiles/disc_grid.h"
#include "silvasim/tiles/radii.h"
#include "silvasim/tiles/region.h"

namespace silvasim::tiles {

struct Throwing {
  double side_m = 0;  // darts are rounded to floats in the frame of the tile in which they lie
  double sites_per_m2 = 0;
  int most_tries = 5000;
};

// Throws into `region` what its area asks for, adds it to `grid`, and returns the discs that lie there.
std::vector<Disc> throw_discs(DiscGrid& grid, const Region& region, const Radii& radii, const Throwing& throwing,
                              base::Stream& random);

// The grid for a window (see DiscGrid) and a density.
DiscGrid grid_for(const base::Box& window, double most_radius_m, double sites_per_m2);

}  // namespace silvasim::tiles
