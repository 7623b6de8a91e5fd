// The traversal of the nested trees, compiled once for each instruction set (see nested.cpp, the only one to include it).
//
// The story of a ray: front to back over the land, in each tile position the tile's sites, for each plant whose hull the ray
// crosses the model's tree, and then the ground beneath. The other layers follow, each with its own tiles.
#include "silvavis/accel/nested.h"
#include "silvavis/accel/nested_sites.h"

// No include guard: Highway includes it once for each target.
HWY_BEFORE_NAMESPACE();
namespace silvavis::accel::HWY_NAMESPACE {

// A leaf of the land: the Wang tile that lies there, and the ground beneath it.
template <bool any_hit>
struct LandWalk {
  const scene::Scene& scene;
  LayerWalk<any_hit> plants;
  bool has_plants;
  bool found = false;

  HWY_INLINE bool operator()(PyramidEntry entry) {
    if (!narrow(scene.land.pyramid, plants.flat, entry)) return false;
    const int column = entry.column + scene.land.first_column, row = entry.row + scene.land.first_row;
    if (has_plants && column >= 0 && row >= 0 && column < plants.layer.columns && row < plants.layer.rows &&
        plants.meet_tile(column, row, entry))
      return found = true;
    const auto most = static_cast<float>(std::min(plants.best, static_cast<double>(entry.far)));
    if (entry.near <= most && nearest_ground(scene, plants.flat, plants.ray, entry.near, most, plants.best)) {
      plants.hit.surface = Surface::ground;
      found = true;
    }
    return any_hit && found;
  }
};

template <bool any_hit>
HWY_INLINE bool trace(const scene::Scene& scene, const Ray& ray, Hit& hit) {
  static const scene::PlantLayer none;
  const FlatRay flat(ray);
  const std::uint64_t hash = scene::ray_hash(ray.origin, ray.direction);
  double best = ray.most;
  const bool has_plants = !scene.layers.empty();
  LandWalk<any_hit> land{
      scene, {scene, has_plants ? scene.layers[0] : none, 0, ray, flat, hash, best, hit, false}, has_plants};
  walk_whole_pyramid(scene.land.pyramid, flat, static_cast<float>(ray.least), best, land);
  if (any_hit && land.found) return true;
  for (std::size_t k = 1; k < scene.layers.size(); ++k) {
    LayerWalk<any_hit> walk{scene, scene.layers[k], static_cast<std::uint8_t>(k), ray, flat, hash, best, hit, false};
    walk_whole_pyramid(scene.layers[k].pyramid, flat, static_cast<float>(ray.least), best, walk);
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

void model_nearest(const scene::PlantModel& model, std::span<const ModelRay> rays, std::span<ModelPoint> points) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ModelHit hit;
    hit.t = 1e30f;
    points[i] = ModelPoint{};
    if (hit_model<false>(model, rays[i].origin, rays[i].direction, rays[i].least, hit))
      points[i] = {hit.t, hit.slot, hit.u, hit.v};
  }
}

void model_occluded(const scene::PlantModel& model, std::span<const ModelRay> rays, std::span<std::uint8_t> answers) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ModelHit hit;
    hit.t = 1e30f;
    answers[i] = hit_model<true>(model, rays[i].origin, rays[i].direction, rays[i].least, hit) ? 1 : 0;
  }
}

}  // namespace silvavis::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
