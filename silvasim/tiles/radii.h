// The distribution of the radii of accepted sites, and where to cut it into equal shares.
//
// Units: metres. Promise: same settings, same bits on every machine (own exp and log, integration by Simpson's rule).
// Source: docs/reading.md, A5: throw the largest first, with a quota a class; here every disc is its own class.
#pragma once

#include <vector>

#include "silvasim/config/tile_settings.h"

namespace silvasim::tiles {

class Radii {
 public:
  // `settings` must have no faults (check.h).
  explicit Radii(const config::TileSettings& settings);

  // The radius that a share `u` in [0,1] of all sites does not exceed; in [least, most] as far as a float can be.
  float quantile(double u) const;

  double mean_m() const { return mean_; }
  double mean_square_m2() const { return mean_square_; }
  double deviation_m() const;

  // How many sites a square metre has when `coverage` of it is under discs.
  double sites_per_m2(double coverage) const;

 private:
  double least_ = 0, most_ = 0;
  double from_ = 0, step_ = 0;  // the table's first radius and the width of an interval
  std::vector<double> share_;   // share of sites up to from_ + i * step_; empty: uniform
  double mean_ = 0, mean_square_ = 0;
};

}  // namespace silvasim::tiles
