#include "silvavis/accel/nested.h"

// Highway compiles the kernel once for each instruction set; AVX-512 brings nothing to lanes of eight and sixteen.
#define HWY_DISABLED_TARGETS (HWY_AVX3 | HWY_AVX3_DL | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "silvavis/accel/nested.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come first.
#include <hwy/highway.h>

#include "silvavis/accel/nested_kernel.h"

#if HWY_ONCE

namespace silvavis::accel {

HWY_EXPORT(trace_nearest);
HWY_EXPORT(trace_occluded);
HWY_EXPORT(details_nearest);
HWY_EXPORT(model_nearest);
HWY_EXPORT(model_occluded);

namespace {

class Nested final : public Tracer {
 public:
  explicit Nested(const scene::Scene& scene) : scene_(scene) {}

  void nearest(std::span<const Ray> rays, std::span<Hit> hits) const override {
    HWY_DYNAMIC_DISPATCH(trace_nearest)(scene_, rays, hits);
  }
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> answers) const override {
    HWY_DYNAMIC_DISPATCH(trace_occluded)(scene_, rays, answers);
  }
  std::size_t bytes() const override { return 0; }

 private:
  const scene::Scene& scene_;
};

}  // namespace

void trace_details(const scene::Scene& scene, std::span<const Ray> rays, std::span<Hit> hits) {
  HWY_DYNAMIC_DISPATCH(details_nearest)(scene, rays, hits);
}
void trace_model(const scene::PlantModel& model, std::span<const ModelRay> rays, std::span<ModelPoint> points) {
  HWY_DYNAMIC_DISPATCH(model_nearest)(model, rays, points);
}
void bar_model(const scene::PlantModel& model, std::span<const ModelRay> rays, std::span<std::uint8_t> answers) {
  HWY_DYNAMIC_DISPATCH(model_occluded)(model, rays, answers);
}

std::unique_ptr<Tracer> make_nested(const scene::Scene& scene) { return std::make_unique<Nested>(scene); }

}  // namespace silvavis::accel

#endif
