// What a scene looks like from above: the light that it sends back to the sky, and the colours of its border.
#pragma once

#include <vector>

#include "silvavis/accel/tracer.h"
#include "silvavis/shade/land.h"

namespace silvavis::commands {

struct OverheadColours {
  Rgb albedo;               // of the scene as a whole
  std::vector<Rgb> border;  // along the planted border, in the order of shade::Surroundings; empty unless asked for
};

// `otherwise`: the albedo where nothing but water is seen.
OverheadColours colours_from_above(const scene::Scene& scene, const accel::Tracer& tracer, const shade::Land& land,
                                   const Rgb& otherwise, bool border);

}  // namespace silvavis::commands
