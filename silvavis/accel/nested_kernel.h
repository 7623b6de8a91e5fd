// The traversal of the nested trees, compiled once for each instruction set (see nested.cpp, the only one to include it).
//
// The story of a ray: with its neighbours front to back over the land, in each tile position through the tile's sites, for each
// plant whose hull it crosses through the model's tree, and then to the ground beneath. The other layers follow, each with its
// own tiles. Neighbours stay together as long as that is less work (nested_bundle.h, nested_packet.h); what a ray meets does
// not hang on its company.
#include "silvavis/accel/nested.h"
#include "silvavis/accel/nested_bundle.h"
#include "silvavis/accel/nested_details.h"
#include "silvavis/accel/nested_packet_sites.h"

// No include guard: Highway includes it once for each target.
HWY_BEFORE_NAMESPACE();
namespace silvavis::accel::HWY_NAMESPACE {

const scene::PlantLayer& layer_or_none(const scene::Scene& scene, std::size_t k) {
  static const scene::PlantLayer none;
  return k < scene.layers.size() ? scene.layers[k] : none;
}

// Where a ray crosses a tile position, and where it may meet the ground there (near > far: nowhere).
struct Crossing {
  PyramidEntry box;
  float ground_near = 1e30f, ground_far = -1e30f;
};

// The tile positions of a layer; those of the first lie on the land.
template <bool any_hit>
struct Leaves {
  const scene::Scene& scene;
  std::size_t k;
  const scene::PlantLayer& layer;
  int first_column, first_row;  // of the pyramid's first node

  HWY_INLINE Leaves(const scene::Scene& of, std::size_t layer_index)
      : scene(of),
        k(layer_index),
        layer(layer_or_none(of, layer_index)),
        first_column(layer_index == 0 ? of.land.first_column : 0),
        first_row(layer_index == 0 ? of.land.first_row : 0) {}
  HWY_INLINE const scene::Pyramid& pyramid() const { return k == 0 ? scene.land.pyramid : layer.pyramid; }
  HWY_INLINE bool has_tile(int column, int row) const {
    return column >= 0 && row >= 0 && column < layer.columns && row < layer.rows;
  }

  // A tile position's plants, which are asked for soon.
  HWY_INLINE void prefetch(int node_column, int node_row) const {
    const int column = node_column + first_column, row = node_row + first_row;
    if (!has_tile(column, row)) return;
    const std::size_t position = layer.position(column, row);
    hwy::Prefetch(&layer.tiles[position]);
    hwy::Prefetch(&layer.base_m[position]);
    hwy::Prefetch(&layer.step_m[position]);
    const std::uint64_t first = layer.first_slot[position], end = layer.first_slot[position + 1];
    // Large tiles are fetched leaf by leaf (nested_sites.h): a ray asks for a small part of them.
    constexpr std::uint64_t most_slots = 256;
    if (end - first > most_slots) return;
    for (std::uint64_t slot = first; slot < end; slot += 64) hwy::Prefetch(layer.plant_species.data() + slot);
    for (std::uint64_t slot = first; slot < end; slot += 32) hwy::Prefetch(layer.plant_heights.data() + slot);
  }

  HWY_INLINE bool cross(const LayerWalk<any_hit>& walk, int node_column, int node_row, Crossing& crossing) const {
    crossing.box = walk.whole_ray(node_column, node_row);
    if (k == 0) return narrow_land(scene.land, walk.flat, crossing.box, crossing.ground_near, crossing.ground_far);
    return narrow(layer.pyramid, walk.flat, crossing.box);
  }
  HWY_INLINE void meet_ground(LayerWalk<any_hit>& walk, const Crossing& crossing) const {
    const auto far = static_cast<float>(std::min(walk.best, static_cast<double>(crossing.ground_far)));
    if (crossing.ground_near > far || !nearest_ground(scene, walk.flat, walk.ray, crossing.ground_near, far, walk.best))
      return;
    walk.hit.surface = Surface::ground;
    walk.found = true;
  }

  // One ray at one leaf; true: something is there, and nothing nearer is asked for.
  HWY_NOINLINE bool meet(LayerWalk<any_hit>& walk, int node_column, int node_row) const {
    Crossing crossing;
    if (!cross(walk, node_column, node_row, crossing)) return false;
    const int column = node_column + first_column, row = node_row + first_row;
    if (has_tile(column, row)) walk.meet_tile(column, row, crossing.box);
    if (!(any_hit && walk.found)) meet_ground(walk, crossing);
    return any_hit && walk.found;
  }

  // These rays at one leaf, together among its plants; the bits of those that ask for nothing more.
  HWY_NOINLINE std::uint32_t meet(LayerWalk<any_hit>* walks, std::uint32_t rays, int node_column, int node_row) const {
    Crossing crossings[packet_size];
    PyramidEntry boxes[packet_size];
    std::uint32_t crossing = 0, answered = 0;
    for (; rays != 0; rays &= rays - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(rays));
      if (!cross(walks[i], node_column, node_row, crossings[i])) continue;
      boxes[i] = crossings[i].box;
      crossing |= 1u << i;
    }
    const int column = node_column + first_column, row = node_row + first_row;
    if (crossing != 0 && has_tile(column, row))
      PacketWalk<any_hit>{scene, layer, walks}.meet_tile(column, row, crossing, boxes);
    for (; crossing != 0; crossing &= crossing - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(crossing));
      if (!(any_hit && walks[i].found)) meet_ground(walks[i], crossings[i]);
      if (any_hit && walks[i].found) answered |= 1u << i;
    }
    return answered;
  }
};

template <bool any_hit>
HWY_INLINE void trace_one(const scene::Scene& scene, const Ray& ray, Hit& hit) {
  const FlatRay flat(ray);
  const std::uint64_t hash = scene::ray_hash(ray.origin, ray.direction);
  double best = ray.most;
  bool found = false;
  for (std::size_t k = 0; k < std::max<std::size_t>(scene.layers.size(), 1) && !found; ++k) {
    const Leaves<any_hit> leaves(scene, k);
    LayerWalk<any_hit> walk{scene, leaves.layer, static_cast<std::uint8_t>(k), ray, flat, hash, best, hit, false};
    const auto leaf = [&](const PyramidEntry& entry)
                          HWY_ATTR { return found = leaves.meet(walk, entry.column, entry.row); };
    walk_whole_pyramid(leaves.pyramid(), flat, static_cast<float>(ray.least), best, leaf);
  }
  if (hit.surface != Surface::none) hit.distance = best;
}

// Values that are made one by one.
template <typename Value>
class PerRay {
 public:
  template <typename... Parts>
  HWY_INLINE void make(std::size_t i, Parts&&... parts) {
    static_assert(std::is_trivially_destructible_v<Value>);
    new (values() + i) Value{std::forward<Parts>(parts)...};
  }
  HWY_INLINE Value& operator[](std::size_t i) { return values()[i]; }
  HWY_INLINE Value* values() { return reinterpret_cast<Value*>(bytes_); }

 private:
  alignas(Value) std::byte bytes_[packet_size * sizeof(Value)];
};

// Neighbours walk among plants together while they are this close to each other, and each by itself farther away: a packet
// that is wider than crowns are meets too much.
constexpr float packet_width_m = 1.0f;

template <bool any_hit>
HWY_INLINE void trace_bundle(const scene::Scene& scene, Bundle& bundle, const Ray* rays, Hit* hits) {
  // A ray that has its answer asks for nothing more.
  constexpr double answered = -1;
  PerRay<LayerWalk<any_hit>> walks;
  for (std::size_t k = 0; k < std::max<std::size_t>(scene.layers.size(), 1); ++k) {
    const Leaves<any_hit> leaves(scene, k);
    for (std::size_t i = 0; i < bundle.count; ++i)
      walks.make(i, scene, leaves.layer, static_cast<std::uint8_t>(k), rays[i], bundle.flats[i],
                 scene::ray_hash(rays[i].origin, rays[i].direction), bundle.bests[i], hits[i], false);
    const auto leaf = [&](std::uint32_t here, float near, int column, int row) HWY_ATTR {
      leaves.prefetch(column, row);
      if (std::popcount(here) >= together_least && bundle.apart + near * bundle.part < packet_width_m) {
        for (std::uint32_t done = leaves.meet(walks.values(), here, column, row); done != 0; done &= done - 1)
          bundle.bests[std::countr_zero(done)] = answered;
        return;
      }
      for (; here != 0; here &= here - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(here));
        if (leaves.meet(walks[i], column, row)) bundle.bests[i] = answered;
      }
    };
    walk_pyramid_together(leaves.pyramid(), bundle, leaf);
  }
  for (std::size_t i = 0; i < bundle.count; ++i)
    if (hits[i].surface != Surface::none) hits[i].distance = bundle.bests[i];
}

template <bool any_hit>
HWY_INLINE void trace(const scene::Scene& scene, std::span<const Ray> rays, Hit* hits) {
  static_assert(Bundle::most_rays == packet_size);
  Bundle bundle;
  const double apart_m = static_cast<double>(scene.land.pyramid.cell_x_m);
  for (std::size_t first = 0; first < rays.size(); first += bundle.count) {
    gather(rays.subspan(first), apart_m, bundle);
    // Towards a light it is most often what lies beside that bars it; from the eye, what the land leaves of the way is short.
    std::uint32_t barred = 0;
    if (any_hit && !scene.details.empty()) {
      for (std::size_t i = 0; i < bundle.count; ++i) {
        double most = rays[first + i].most;
        if (!meet_details<true>(scene, rays[first + i], most, hits[first + i])) continue;
        barred |= 1u << i;
        bundle.bests[i] = -1;
      }
      if (std::popcount(barred) == static_cast<int>(bundle.count)) continue;
    }
    if (bundle.count > 1) {
      trace_bundle<any_hit>(scene, bundle, &rays[first], hits + first);
    } else {
      trace_one<any_hit>(scene, rays[first], hits[first]);
    }
    if (!any_hit && !scene.details.empty()) {
      for (std::size_t i = first; i < first + bundle.count; ++i) {
        double best = std::min(rays[i].most, hits[i].distance);
        meet_details<false>(scene, rays[i], best, hits[i]);
      }
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

void details_nearest(const scene::Scene& scene, std::span<const Ray> rays, std::span<Hit> hits) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    hits[i] = Hit{};
    double best = rays[i].most;
    meet_details<false>(scene, rays[i], best, hits[i]);
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
