// The nested trees: a pyramid over tile positions, a tree over each Wang tile's sites, a tree a model.
//
// Nothing is built but what the scene holds. The kernel is compiled for several instruction sets, and the machine's best is
// taken when the program starts; all give the same bits.
// Source: Silva 2013, section 5; Dietrich, Marmitt and Slusallek 2006. docs/tracing.md tells what was measured.
#pragma once

#include "silvavis/accel/tracer.h"

namespace silvavis::accel {

// `scene` must outlive it.
std::unique_ptr<Tracer> make_nested(const scene::Scene& scene);

}  // namespace silvavis::accel
