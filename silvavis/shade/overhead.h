// What land with all that stands on it throws back, measured by rays: for the sky above it, and for the land around it.
//
// Colours are shares of the light on level land, the shade that plants cast on each other and on the ground included.
// Rays are spread evenly (Roberts 2018), no number is drawn: the same scene gives the same colours on any number of threads.
// Threads: any; parallel inside. Cost: some 10 to 50 ms each.
#pragma once

#include <vector>

#include "silvasim/base/geometry.h"
#include "silvavis/accel/tracer.h"
#include "silvavis/shade/land.h"
#include "silvavis/shade/sky.h"

namespace silvavis::shade {

// Keeps references.
struct Overhead {
  const scene::Scene& scene;
  const accel::Tracer& tracer;
  const Land& land;
  double top_m;  // above all that stands there
};

// Of the whole extent, seen from aslant and all sides under a sun half up the sky that gives 85 % of the light. `otherwise`: where all is water.
Rgb albedo_from_above(const Overhead& overhead, const Rgb& otherwise);

// The same along the border of the extent, in Surroundings' parts.
std::vector<Rgb> border_colours(const Overhead& overhead, const Rgb& otherwise);

// What gentle land in the extent looks like, place by place, from the darkest to the lightest: Surroundings::shades of them.
std::vector<Rgb> usual_colours(const Overhead& overhead, const Rgb& otherwise);

// Under the light of an hour.
struct SentBack {
  Views views;  // how much lighter the gentle land looks, from where, than level ground of `albedo` in the same light
  Rgb among{0, 0, 0};  // mean radiance of what bars the sky from leaves and ground
};
SentBack sent_back(const Overhead& overhead, const Sky& sky, const Rgb& albedo);

}  // namespace silvavis::shade
