// The walk within a tile position: its Wang tile's tree of sites, and the plants that stand on them.
#if defined(SILVAVIS_NESTED_SITES) == defined(HWY_TARGET_TOGGLE)
#ifdef SILVAVIS_NESTED_SITES
#undef SILVAVIS_NESTED_SITES
#else
#define SILVAVIS_NESTED_SITES
#endif

#include "silvavis/accel/nested_ground.h"
#include "silvavis/accel/nested_model.h"
#include "silvavis/scene/instance.h"

HWY_BEFORE_NAMESPACE();
namespace silvavis::accel::HWY_NAMESPACE {

constexpr float site_slack_m = 0.02f;  // of the heights between which a plant can stand

// Where a ray enters the circles of a leaf's sites, how far it passes from their middles and how low above their feet.
struct SiteCrossings {
  HWY_ALIGN float nears[16];
  HWY_ALIGN float besides[16];
  HWY_ALIGN float lows[16];
};

template <bool any_hit>
struct LayerWalk {
  const scene::Scene& scene;
  const scene::PlantLayer& layer;
  std::uint8_t layer_index;
  const Ray& ray;
  const FlatRay& flat;
  std::uint64_t hash;  // of the ray
  double& best;
  Hit& hit;
  bool found;

  // As an entry of level 0 of a pyramid, whatever boxes the walk came through.
  HWY_INLINE PyramidEntry whole_ray(int column, int row) const {
    return {static_cast<float>(ray.least), static_cast<float>(std::min(best, 1e30)), 0, column, row};
  }

  // A tile position whose box the ray crosses.
  HWY_INLINE bool meet_tile(int column, int row, const PyramidEntry& box) {
    const std::size_t position = layer.position(column, row);
    const scene::TileSites& tile = layer.tile_sites[layer.tiles[position]];
    if (tile.count == 0) return false;
    const TileRay r = ray_in_tile(column, row, box);
    if (r.least > r.most) return false;
    walk_tile(tile, position, column, row, r);
    return any_hit && found;
  }

  struct TileRay {
    float x, y, z;      // tile space; z as in the world
    float least, most;  // distances from `begin`
    double begin;
  };

  HWY_INLINE TileRay ray_in_tile(int column, int row, const PyramidEntry& box) const {
    const float near = box.near, far = box.far;
    // Begin anew where the ray enters, so that floats in the tile's space keep their millimetres.
    const auto begin = static_cast<double>(near);
    const auto moved = [&](double at, double corner, float direction) HWY_ATTR {
      return static_cast<float>(at - corner + begin * static_cast<double>(direction));
    };
    TileRay r;
    r.x = moved(ray.origin.x, layer.west + column * layer.tile_side_m, ray.direction.x);
    r.y = moved(ray.origin.y, layer.south + row * layer.tile_side_m, ray.direction.y);
    r.z = moved(ray.origin.z, 0, ray.direction.z);
    r.begin = begin;
    constexpr float slack_m = 0.05f;
    r.least = std::max(0.0f, static_cast<float>(ray.least - begin));
    r.most = far - near + slack_m;
    return r;
  }

  HWY_INLINE float limit(const TileRay& r) const {
    return std::min(r.most, static_cast<float>(std::min(best - r.begin, 1e30)));
  }

  HWY_INLINE void walk_tile(const scene::TileSites& tile, std::size_t position, int column, int row, const TileRay& r) {
    std::uint64_t stack[8 * 15 + 1];
    int size = 0;
    stack[size++] = waiting(r.least, 0, false);
    while (size > 0) {
      const std::uint64_t entry = stack[--size];
      const float most = limit(r);
      if (distance_of(entry) > most) continue;
      if (is_leaf(entry)) {
        walk_leaf(tile, position, column, row, r, scene::SiteLeaf::of(index_of(entry)));
        if (any_hit && found) return;
        continue;
      }
      const scene::SiteNode& node = tile.nodes[index_of(entry)];
      const float* const x_in = flat.dx < 0 ? node.most_x.data() : node.least_x.data();
      const float* const x_out = flat.dx < 0 ? node.least_x.data() : node.most_x.data();
      const float* const y_in = flat.dy < 0 ? node.most_y.data() : node.least_y.data();
      const float* const y_out = flat.dy < 0 ? node.least_y.data() : node.most_y.data();
      HWY_ALIGN float nears[16];
      std::uint32_t hits = 0;
      const V8 ox = hn::Set(f8, r.x), oy = hn::Set(f8, r.y), ix = hn::Set(f8, flat.ix), iy = hn::Set(f8, flat.iy);
      for (std::size_t k = 0; k < 16; k += hn::Lanes(f8)) {
        const V8 near = hn::Max(hn::Max(hn::Mul(hn::Sub(hn::LoadU(f8, x_in + k), ox), ix),
                                        hn::Mul(hn::Sub(hn::LoadU(f8, y_in + k), oy), iy)),
                                hn::Set(f8, r.least));
        const V8 far = hn::Min(hn::Min(hn::Mul(hn::Sub(hn::LoadU(f8, x_out + k), ox), ix),
                                       hn::Mul(hn::Sub(hn::LoadU(f8, y_out + k), oy), iy)),
                               hn::Set(f8, most));
        // Children without sites have their least above their most, so that near is beyond far.
        hn::Store(near, f8, nears + k);
        hits |= bits_of(f8, hn::Le(near, far)) << k;
      }
      // The farthest is pushed first.
      const int bottom = size;
      while (hits != 0) {
        const auto child = static_cast<std::uint32_t>(std::countr_zero(hits));
        hits &= hits - 1;
        if (node.above_leaves) prefetch_leaf(position, node.children[child]);
        insert(stack, size, bottom, waiting(nears[child], node.children[child], node.above_leaves));
      }
    }
  }

  HWY_INLINE void prefetch_leaf(std::size_t position, std::uint32_t packed) const {
    const std::size_t slot = layer.first_slot[position] + scene::SiteLeaf::of(packed).first_slot;
    hwy::Prefetch(layer.plant_species.data() + slot);
    hwy::Prefetch(layer.plant_heights.data() + slot);
  }

  // A leaf's sites: the circle that each plant can reach, and the heights between which it can stand. Bits of those that the ray
  // crosses.
  HWY_INLINE std::uint32_t cross_leaf(const scene::TileSites& tile, std::size_t position, const TileRay& r,
                                      scene::SiteLeaf leaf, SiteCrossings& crossings) const {
    const std::size_t slot0 = leaf.first_slot;
    const std::uint16_t* const heights = layer.plant_heights.data() + layer.first_slot[position] + slot0;
    const float hx = flat.ahead_x, hy = flat.ahead_y, per_run = flat.per_run;
    std::uint32_t hits = 0;
    const V8 zero = hn::Zero(f8), least = hn::Set(f8, r.least), most = hn::Set(f8, limit(r));
    for (std::size_t k = 0; k < leaf.slots; k += hn::Lanes(f8)) {
      const V8 px = hn::Sub(hn::LoadU(f8, tile.x_m.data() + slot0 + k), hn::Set(f8, r.x));
      const V8 py = hn::Sub(hn::LoadU(f8, tile.y_m.data() + slot0 + k), hn::Set(f8, r.y));
      const V8 reach = hn::LoadU(f8, tile.reach_m.data() + slot0 + k);
      const V8 along = hn::Add(hn::Mul(px, hn::Set(f8, hx)), hn::Mul(py, hn::Set(f8, hy)));
      const V8 beside = hn::Sub(hn::Mul(px, hn::Set(f8, hy)), hn::Mul(py, hn::Set(f8, hx)));
      const V8 square = hn::Sub(hn::Mul(reach, reach), hn::Mul(beside, beside));
      auto crossed = hn::And(hn::Ge(square, zero), hn::Gt(reach, zero));
      const V8 chord = hn::Sqrt(hn::Max(square, zero));
      const V8 near = hn::Max(hn::Mul(hn::Sub(along, chord), hn::Set(f8, per_run)), least);
      const V8 far = hn::Min(hn::Mul(hn::Add(along, chord), hn::Set(f8, per_run)), most);
      crossed = hn::And(crossed, hn::Le(near, far));
      const V8 z_in = hn::Add(hn::Set(f8, r.z), hn::Mul(hn::Set(f8, flat.dz), near));
      const V8 z_out = hn::Add(hn::Set(f8, r.z), hn::Mul(hn::Set(f8, flat.dz), far));
      const V8 foot = hn::Add(hn::Set(f8, layer.base_m[position]),
                              hn::Mul(hn::Set(f8, layer.step_m[position]), floats_of(heights + k)));
      const V8 radius = hn::LoadU(f8, tile.radius_m.data() + slot0 + k);
      const V8 tip = hn::Add(foot, hn::Add(hn::Mul(radius, hn::Set(f8, layer.most_height)), hn::Set(f8, site_slack_m)));
      const V8 root =
          hn::Add(foot, hn::Sub(hn::Mul(radius, hn::Set(f8, layer.least_height)), hn::Set(f8, site_slack_m)));
      const V8 lowest = hn::Min(z_in, z_out);
      crossed = hn::And(crossed, hn::Le(lowest, tip));
      crossed = hn::And(crossed, hn::Ge(hn::Max(z_in, z_out), root));
      hn::Store(near, f8, crossings.nears + k);
      hn::Store(hn::Abs(beside), f8, crossings.besides + k);
      hn::Store(hn::Sub(lowest, foot), f8, crossings.lows + k);
      hits |= bits_of(f8, crossed) << k;
    }
    return hits;
  }

  HWY_INLINE void walk_leaf(const scene::TileSites& tile, std::size_t position, int column, int row, const TileRay& r,
                            scene::SiteLeaf leaf) {
    const std::size_t slot0 = leaf.first_slot;
    const std::uint8_t* const species = layer.plant_species.data() + layer.first_slot[position] + slot0;
    SiteCrossings crossings;
    std::uint32_t hits = cross_leaf(tile, position, r, leaf, crossings);
    const float* const nears = crossings.nears;
    // The nearest first.
    std::uint32_t order[16];
    int count = 0;
    while (hits != 0) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(hits));
      hits &= hits - 1;
      if (species[lane] == scene::no_species) continue;
      // Most species are smaller than the layer's tallest and widest.
      const scene::SpeciesModels& kind = layer.species[species[lane]];
      const float radius = tile.radius_m[slot0 + lane];
      if (crossings.besides[lane] > radius * kind.most_reach + site_slack_m ||
          crossings.lows[lane] > radius * kind.most_height + site_slack_m)
        continue;
      int at = count++;
      for (; at > 0 && nears[order[at - 1]] > nears[lane]; --at) order[at] = order[at - 1];
      order[at] = lane;
    }
    for (int i = 0; i < count; ++i) {
      if (nears[order[i]] > limit(r)) return;
      meet_plant(column, row, static_cast<std::uint32_t>(slot0) + order[i], species[order[i]]);
      if (any_hit && found) return;
    }
  }

  HWY_INLINE bool is_left(int column, int row, std::uint32_t slot) const {
    return slot == ray.left_slot && column == ray.left_column && row == ray.left_row && layer_index == ray.left_layer;
  }

  HWY_INLINE std::uint8_t level_of(const scene::Instance& plant, const scene::LocalRay& local) const {
    if (ray.width_m <= 0 && ray.spread <= 0) return 0;
    const float width = ray.width_m + ray.spread * static_cast<float>(std::max(local.start, 0.0));
    return scene::level_for(*scene.models[plant.model], plant, width);
  }

  HWY_INLINE void meet_plant(int column, int row, std::uint32_t slot, std::uint8_t species) {
    if (is_left(column, row, slot)) return;
    const scene::Instance plant = scene::instance_at(scene, layer, column, row, slot, species);
    const scene::LocalRay local = scene::local_ray(plant, ray.origin, ray.direction);
    const std::uint8_t level = level_of(plant, local);
    const scene::PlantModel& full = *scene.models[plant.model];
    if (scene::is_impostor(full, level)) return meet_impostor(full, plant, local, column, row, slot, species, level);
    const scene::PlantModel& model = level == 0 ? full : *full.coarser[level - 1u];
    float least = 0;
    ModelHit model_hit;
    begin_model(plant, local, least, model_hit);
    if (!hit_model<any_hit>(model, local.origin, local.direction, least, model_hit)) return;
    keep_nearer(plant, local, column, row, slot, species, level, model_hit);
  }

  // Between which distances the model counts.
  HWY_INLINE void begin_model(const scene::Instance& plant, const scene::LocalRay& local, float& least,
                              ModelHit& model_hit) const {
    const double size = 1.0 / static_cast<double>(plant.scale);
    model_hit.t = static_cast<float>(std::min((best - local.start) * size, 1e30));
    // Not less than that in doubles, so that what is kept does not hang on which plant comes first.
    model_hit.t += std::abs(model_hit.t) * 0x1p-22f;
    least = static_cast<float>((ray.least - local.start) * size);
  }

  HWY_INLINE void keep_nearer(const scene::Instance& plant, const scene::LocalRay& local, int column, int row,
                              std::uint32_t slot, std::uint8_t species, std::uint8_t level, const ModelHit& model_hit) {
    const double distance = local.start + static_cast<double>(model_hit.t) * static_cast<double>(plant.scale);
    if (distance >= best || distance < ray.least) return;
    keep(distance, plant, column, row, slot, species, level, model_hit);
  }

  HWY_INLINE void meet_impostor(const scene::PlantModel& model, const scene::Instance& plant,
                                const scene::LocalRay& local, int column, int row, std::uint32_t slot,
                                std::uint8_t species, std::uint8_t level) {
    const std::uint64_t chance =
        scene::mixed(hash + (std::uint64_t{static_cast<std::uint32_t>(column)} << 40) +
                     (std::uint64_t{static_cast<std::uint32_t>(row)} << 20) + slot * 0x9E3779B97F4A7C15u);
    ModelHit model_hit;
    model_hit.slot = scene::meet_impostor(*model.impostor, local.origin, local.direction, plant.side, chance);
    if (model_hit.slot == scene::no_point) return;
    // The point may lie before the ray, since it was met by another one; but not before the circle that the plant can reach, so
    // that what is kept does not hang on which plant comes first.
    const V3 &o = local.origin, &d = local.direction;
    const float reach = layer.most_reach * layer.species[species].model_radius_m;
    const float a = std::max(d.x * d.x + d.y * d.y, 1e-12f), b = o.x * d.x + o.y * d.y;
    const float square = b * b - a * (o.x * o.x + o.y * o.y - reach * reach);
    constexpr double rounding_m = 1e-3;
    const double enters =
        static_cast<double>((-b - std::sqrt(std::max(square, 0.0f))) / a) * static_cast<double>(plant.scale) +
        rounding_m;
    const double distance = local.start + std::max(static_cast<double>(model.impostor->points[model_hit.slot].depth_m) *
                                                       static_cast<double>(plant.scale),
                                                   enters);
    if (distance >= best || distance < ray.least) return;
    keep(distance, plant, column, row, slot, species, level, model_hit);
  }

  HWY_INLINE void keep(double distance, const scene::Instance& plant, int column, int row, std::uint32_t slot,
                       std::uint8_t species, std::uint8_t level, const ModelHit& model_hit) {
    best = distance;
    found = true;
    hit.surface = Surface::plant;
    hit.layer = layer_index;
    hit.species = species;
    hit.column = column;
    hit.row = row;
    hit.site_slot = slot;
    hit.model = plant.model;
    hit.level = level;
    hit.slot = model_hit.slot;
    hit.u = model_hit.u;
    hit.v = model_hit.v;
  }
};

}  // namespace silvavis::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
