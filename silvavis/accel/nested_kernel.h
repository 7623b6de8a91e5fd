// The traversal of the nested trees, compiled once for each instruction set (see nested.cpp, the only one to include it).
//
// The story of a ray: ground first, since it bounds all that follows; then, layer by layer, tile positions front to back, in
// each the tile's sites, and for each plant whose hull the ray crosses the model's tree.
#include "silvavis/accel/nested_ground.h"
#include "silvavis/accel/nested_sites.h"

// No include guard: Highway includes it once for each target.
HWY_BEFORE_NAMESPACE();
namespace silvavis::accel::HWY_NAMESPACE {

template <bool any_hit>
HWY_INLINE bool trace(const scene::Scene& scene, const Ray& ray, Hit& hit) {
  const FlatRay flat(ray);
  double best = ray.most;
  if (nearest_ground(scene.ground, flat, ray, best)) {
    hit.surface = Surface::ground;
    if (any_hit) return true;
  }
  for (std::size_t k = 0; k < scene.layers.size(); ++k) {
    LayerWalk<any_hit> walk{scene, scene.layers[k], static_cast<std::uint8_t>(k), ray, flat, best, hit, false};
    walk_pyramid(scene.layers[k].pyramid, flat, static_cast<float>(ray.least), best, walk);
    if (any_hit && walk.found) return true;
  }
  if (hit.surface != Surface::none) hit.distance = best;
  return hit.surface != Surface::none;
}

void trace_nearest(const scene::Scene& scene, std::span<const Ray> rays, std::span<Hit> hits) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    hits[i] = Hit{};
    trace<false>(scene, rays[i], hits[i]);
  }
}

void trace_occluded(const scene::Scene& scene, std::span<const Ray> rays, std::span<std::uint8_t> answers) {
  Hit ignored;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ignored.surface = Surface::none;
    answers[i] = trace<true>(scene, rays[i], ignored) ? 1 : 0;
  }
}

}  // namespace silvavis::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
