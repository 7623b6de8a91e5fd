// What a user may say about the Wang tiles of a vegetation layer.
#pragma once

#include "silvasim/base/place.h"

namespace silvasim::config {

enum class TileMode { paper, seamless };

// How the radii of the *accepted* sites are distributed between least and most.
enum class RadiusDistribution { uniform, normal, lognormal };

struct TileSettings {
  double side_m = 200;
  int colours = 3;   // in each direction; colours² * variants tiles
  int variants = 2;  // at most colours - 1
  TileMode mode = TileMode::paper;
  double least_radius_m = 2;
  double most_radius_m = 8;
  RadiusDistribution distribution = RadiusDistribution::uniform;
  double mean_radius_m = 0;       // normal, lognormal: before truncation; 0: the middle
  double deviation_radius_m = 0;  // normal, lognormal: before truncation; 0: a sixth of the range
  double coverage = 0.5;          // share of the ground under discs, in (0, 0.6]
  base::Place place;              // where errors point

  friend bool operator==(const TileSettings&, const TileSettings&) = default;
};

}  // namespace silvasim::config
