// The same scene in one flat structure of Embree: the baseline for speed and memory, and the oracle for correctness.
//
// Errors: base::Error where Embree fails (memory). Cost: about 0.5 kB a plant.
#pragma once

#include "silvavis/accel/tracer.h"

namespace silvavis::accel {

enum class Flat {
  instances,  // each plant an instance of Embree with its matrix: what other renderers do
  packets,    // the same, sixteen rays in a row at once: the faster way where neighbours meet the same plants
  exact,  // each plant a primitive whose ray is decoded by scene::local_ray(): the same plant in every pixel, slower
};

// `scene` must outlive it.
std::unique_ptr<Tracer> make_embree(const scene::Scene& scene, Flat flat = Flat::instances);

}  // namespace silvavis::accel
