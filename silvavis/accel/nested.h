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

// The details alone, without land and plants.
void trace_details(const scene::Scene& scene, std::span<const Ray> rays, std::span<Hit> hits);

// One model by itself, in its own space: what is made of models asks here.
struct ModelRay {
  V3 origin{0, 0, 0};
  V3 direction{0, 0, 1};  // unit length
  float least = 0;
};
struct ModelPoint {
  float t = std::numeric_limits<float>::infinity();  // infinite: no hit
  std::uint32_t slot = 0;
  float u = 0, v = 0;
};
void trace_model(const scene::PlantModel& model, std::span<const ModelRay> rays, std::span<ModelPoint> points);
// 1 where anything is met.
void bar_model(const scene::PlantModel& model, std::span<const ModelRay> rays, std::span<std::uint8_t> answers);

}  // namespace silvavis::accel
