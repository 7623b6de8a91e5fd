// The traversal of the nested trees, compiled once for each instruction set (see nested.cpp, the only one to include it).
//
// The story of a ray: with its neighbours front to back over the land, alone in each tile position through the tile's sites, for
// each plant whose hull it crosses through the model's tree, and then to the ground beneath. The other layers follow, each with
// its own tiles.
#include "silvavis/accel/nested.h"
#include "silvavis/accel/nested_bundle.h"
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

  HWY_INLINE bool operator()(int node_column, int node_row) {
    PyramidEntry entry = plants.whole_ray(node_column, node_row);
    float ground_near = 0, ground_far = 0;
    if (!narrow_land(scene.land, plants.flat, entry, ground_near, ground_far)) return false;
    const int column = node_column + scene.land.first_column, row = node_row + scene.land.first_row;
    if (has_plants && column >= 0 && row >= 0 && column < plants.layer.columns && row < plants.layer.rows &&
        plants.meet_tile(column, row, entry))
      return found = true;
    const auto most = static_cast<float>(std::min(plants.best, static_cast<double>(ground_far)));
    if (ground_near <= most && nearest_ground(scene, plants.flat, plants.ray, ground_near, most, plants.best)) {
      plants.hit.surface = Surface::ground;
      found = true;
    }
    return any_hit && found;
  }
};

const scene::PlantLayer& first_layer(const scene::Scene& scene) {
  static const scene::PlantLayer none;
  return scene.layers.empty() ? none : scene.layers.front();
}

// A leaf of the land, and of another layer, for one ray; true: something is there, and nothing nearer is asked for.
template <bool any_hit>
HWY_NOINLINE bool meet_land(const scene::Scene& scene, const Ray& ray, const FlatRay& flat, std::uint64_t hash,
                            int column, int row, double& best, Hit& hit) {
  LandWalk<any_hit> walk{
      scene, {scene, first_layer(scene), 0, ray, flat, hash, best, hit, false}, !scene.layers.empty()};
  return walk(column, row);
}
template <bool any_hit>
HWY_NOINLINE bool meet_layer(const scene::Scene& scene, std::size_t k, const Ray& ray, const FlatRay& flat,
                             std::uint64_t hash, int column, int row, double& best, Hit& hit) {
  LayerWalk<any_hit> walk{scene, scene.layers[k], static_cast<std::uint8_t>(k), ray, flat, hash, best, hit, false};
  return walk(column, row);
}

template <bool any_hit>
HWY_INLINE void trace_one(const scene::Scene& scene, const Ray& ray, Hit& hit) {
  const FlatRay flat(ray);
  const std::uint64_t hash = scene::ray_hash(ray.origin, ray.direction);
  const auto least = static_cast<float>(ray.least);
  double best = ray.most;
  bool found = false;
  const auto land = [&](const PyramidEntry& entry) HWY_ATTR {
    return found = meet_land<any_hit>(scene, ray, flat, hash, entry.column, entry.row, best, hit);
  };
  walk_whole_pyramid(scene.land.pyramid, flat, least, best, land);
  for (std::size_t k = 1; k < scene.layers.size() && !found; ++k) {
    const auto layer = [&](const PyramidEntry& entry) HWY_ATTR {
      return found = meet_layer<any_hit>(scene, k, ray, flat, hash, entry.column, entry.row, best, hit);
    };
    walk_whole_pyramid(scene.layers[k].pyramid, flat, least, best, layer);
  }
  if (hit.surface != Surface::none) hit.distance = best;
}

// Of neighbours: bundle.count rays.
template <bool any_hit>
HWY_INLINE void trace_together(const scene::Scene& scene, Bundle& bundle, const Ray* rays, Hit* hits) {
  std::uint64_t hashes[Bundle::most_rays];
  for (std::size_t i = 0; i < bundle.count; ++i) hashes[i] = scene::ray_hash(rays[i].origin, rays[i].direction);
  // A ray that has its answer asks for nothing more.
  constexpr double answered = -1;
  const auto land = [&](std::size_t i, int column, int row) HWY_ATTR {
    if (meet_land<any_hit>(scene, rays[i], bundle.flats[i], hashes[i], column, row, bundle.bests[i], hits[i]))
      bundle.bests[i] = answered;
  };
  walk_together(scene.land.pyramid, bundle, land);
  for (std::size_t k = 1; k < scene.layers.size(); ++k) {
    const auto layer = [&](std::size_t i, int column, int row) HWY_ATTR {
      if (meet_layer<any_hit>(scene, k, rays[i], bundle.flats[i], hashes[i], column, row, bundle.bests[i], hits[i]))
        bundle.bests[i] = answered;
    };
    walk_together(scene.layers[k].pyramid, bundle, layer);
  }
  for (std::size_t i = 0; i < bundle.count; ++i)
    if (hits[i].surface != Surface::none) hits[i].distance = bundle.bests[i];
}

// Calls with runs of rays that walk together.
template <bool any_hit>
HWY_INLINE void trace(const scene::Scene& scene, std::span<const Ray> rays, Hit* hits) {
  Bundle bundle;
  const double apart_m = static_cast<double>(scene.land.pyramid.cell_x_m);
  for (std::size_t first = 0; first < rays.size(); first += bundle.count) {
    gather(rays.subspan(first), apart_m, bundle);
    if (bundle.count > 1) {
      trace_together<any_hit>(scene, bundle, &rays[first], hits + first);
    } else {
      trace_one<any_hit>(scene, rays[first], hits[first]);
    }
  }
}

void trace_nearest(const scene::Scene& scene, std::span<const Ray> rays, std::span<Hit> hits) {
  std::fill(hits.begin(), hits.end(), Hit{});
  trace<false>(scene, rays, hits.data());
}

void trace_occluded(const scene::Scene& scene, std::span<const Ray> rays, std::span<std::uint8_t> answers) {
  constexpr std::size_t most = 128;
  Hit hits[most];
  for (std::size_t first = 0; first < rays.size(); first += most) {
    const std::size_t count = std::min(most, rays.size() - first);
    std::fill_n(hits, count, Hit{});
    trace<true>(scene, rays.subspan(first, count), hits);
    for (std::size_t i = 0; i < count; ++i) answers[first + i] = hits[i].surface != Surface::none ? 1 : 0;
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
