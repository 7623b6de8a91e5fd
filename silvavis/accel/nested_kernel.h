// The traversal of the nested trees, compiled once for each instruction set (see nested.cpp, the only one to include it).
//
// The story of a ray: front to back over the land, in each tile position the tile's sites, for each plant whose hull the ray
// crosses the model's tree, and then the ground beneath. The other layers follow, each with its own tiles.
#include <cstddef>
#include <new>
#include <optional>
#include <type_traits>
#include <utility>

#include "silvavis/accel/nested.h"
#include "silvavis/accel/nested_packet.h"
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

// A value a ray, made one by one.
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

// The next node of level 0 on a ray's way, or none: a step of walk_pyramid().
HWY_INLINE bool next_leaf(const scene::Pyramid& pyramid, const FlatRay& ray, PyramidStack& stack, const double& best,
                          PyramidEntry& leaf) {
  bool there = false;
  const auto take = [&](const PyramidEntry& entry) HWY_ATTR {
    leaf = entry;
    return there = true;
  };
  walk_pyramid<0>(pyramid, ray, stack, best, take);
  return there;
}

// How far apart rays that go about the same way are at a distance; none where they do not.
struct Spread {
  float apart_m = 0, angle = 0;
  HWY_INLINE float at(float distance) const { return apart_m + angle * distance; }
};
HWY_INLINE std::optional<Spread> spread_of(const Ray* rays, std::size_t count) {
  const Ray& first = rays[0];
  float cosine = 1;
  double apart = 0;
  for (std::size_t i = 1; i < count; ++i) {
    const Ray& ray = rays[i];
    if ((ray.direction.x < 0) != (first.direction.x < 0) || (ray.direction.y < 0) != (first.direction.y < 0)) return {};
    cosine = std::min(cosine, ray.direction.dot(first.direction));
    const V3d between = ray.origin - first.origin;
    apart = std::max({apart, std::abs(between.x), std::abs(between.y), std::abs(between.z)});
  }
  if (cosine < 0.9995f || apart > 1) return {};
  return Spread{static_cast<float>(apart), std::sqrt(std::max(0.0f, 2 - 2 * cosine))};
}

// As trace() for up to sixteen rays: each goes its own way over the land, and those that come to the same tile position walk
// through it together. False, and nothing is done, where they are too far apart by then.
template <bool any_hit>
bool trace_together(const scene::Scene& scene, const Ray* rays, std::size_t count, const Spread& spread, Hit* hits) {
  constexpr float most_apart_m = 2;
  const scene::Pyramid& land = scene.land.pyramid;
  const float above_m = static_cast<float>(rays[0].origin.z) - (land.origin_m + 65535 * land.step_m);
  if (spread.at(std::max(above_m, 0.0f)) > most_apart_m) return false;
  static const scene::PlantLayer none;
  PerRay<FlatRay> flats;
  PerRay<LayerWalk<any_hit>> walks;
  double best[packet_size];
  PyramidStack stacks[packet_size];
  PyramidEntry entries[packet_size];
  for (std::size_t i = 0; i < count; ++i) {
    flats.make(i, rays[i]);
    best[i] = rays[i].most;
  }
  std::uint32_t open = (1u << count) - 1;
  for (std::size_t k = 0; k < std::max<std::size_t>(scene.layers.size(), 1) && open != 0; ++k) {
    const bool has_plants = !scene.layers.empty(), with_ground = k == 0;
    const scene::PlantLayer& layer = has_plants ? scene.layers[k] : none;
    const scene::Pyramid& pyramid = with_ground ? scene.land.pyramid : layer.pyramid;
    for (std::size_t i = 0; i < count; ++i) {
      walks.make(i, scene, layer, static_cast<std::uint8_t>(k), rays[i], flats[i],
                 scene::ray_hash(rays[i].origin, rays[i].direction), best[i], hits[i], false);
      stacks[i].size = 0;
      stacks[i].push({static_cast<float>(rays[i].least), static_cast<float>(std::min(best[i], 1e30)),
                      static_cast<std::int32_t>(pyramid.levels.size()) - 1, 0, 0});
    }
    PacketWalk<any_hit> together{scene, layer, walks.values()};
    bool begins = k == 0;
    for (std::uint32_t going = open; going != 0; begins = false) {
      std::uint32_t arrived = 0;
      for (std::uint32_t left = going; left != 0; left &= left - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(left));
        bool there = false;
        while (!there && next_leaf(pyramid, flats[i], stacks[i], best[i], entries[i]))
          there = narrow(pyramid, flats[i], entries[i]);
        (there ? arrived : going) ^= 1u << i;
      }
      if (begins && arrived != 0 && spread.at(entries[std::countr_zero(arrived)].near) > most_apart_m) return false;
      const int first_column = with_ground ? scene.land.first_column : 0,
                first_row = with_ground ? scene.land.first_row : 0;
      for (std::uint32_t left = has_plants ? arrived : 0; left != 0;) {
        const PyramidEntry& at = entries[std::countr_zero(left)];
        std::uint32_t here = 0;
        for (std::uint32_t others = left; others != 0; others &= others - 1) {
          const auto i = static_cast<std::size_t>(std::countr_zero(others));
          if (entries[i].column == at.column && entries[i].row == at.row) here |= 1u << i;
        }
        left ^= here;
        const int column = at.column + first_column, row = at.row + first_row;
        if (column >= 0 && row >= 0 && column < layer.columns && row < layer.rows)
          together.meet_tile(column, row, here, entries);
      }
      for (std::uint32_t left = arrived; left != 0; left &= left - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(left));
        if (with_ground && !(any_hit && walks[i].found)) {
          const auto most = static_cast<float>(std::min(best[i], static_cast<double>(entries[i].far)));
          if (entries[i].near <= most && nearest_ground(scene, flats[i], rays[i], entries[i].near, most, best[i])) {
            hits[i].surface = Surface::ground;
            walks[i].found = true;
          }
        }
        if (any_hit && walks[i].found) {
          going &= ~(1u << i);
          open &= ~(1u << i);
        }
      }
    }
  }
  for (std::size_t i = 0; i < count; ++i)
    if (hits[i].surface != Surface::none) hits[i].distance = best[i];
  return true;
}

// Sixteen rays in a row together where they keep together, else one by one.
template <bool any_hit>
HWY_INLINE void trace_all(const scene::Scene& scene, std::span<const Ray> rays, Hit* hits) {
  constexpr int wait = 7;  // packets that are not tried after one that was too wide
  int waits = 0;
  for (std::size_t i = 0; i < rays.size(); i += packet_size) {
    const std::size_t count = std::min(packet_size, rays.size() - i);
    for (std::size_t k = 0; k < count; ++k) hits[i + k] = Hit{};
    if (--waits < 0 && count >= packet_size / 2) {
      const auto spread = spread_of(&rays[i], count);
      if (spread && trace_together<any_hit>(scene, &rays[i], count, *spread, hits + i)) continue;
      waits = wait;
    }
    for (std::size_t k = 0; k < count; ++k) trace<any_hit>(scene, rays[i + k], hits[i + k]);
  }
}

void trace_nearest(const scene::Scene& scene, std::span<const Ray> rays, std::span<Hit> hits) {
  trace_all<false>(scene, rays, hits.data());
}

void trace_occluded(const scene::Scene& scene, std::span<const Ray> rays, std::span<std::uint8_t> answers) {
  constexpr std::size_t batch = 16 * packet_size;
  Hit ignored[batch];
  for (std::size_t i = 0; i < rays.size(); i += batch) {
    const std::size_t count = std::min(batch, rays.size() - i);
    trace_all<true>(scene, rays.subspan(i, count), ignored);
    for (std::size_t k = 0; k < count; ++k) answers[i + k] = ignored[k].surface != Surface::none ? 1 : 0;
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
