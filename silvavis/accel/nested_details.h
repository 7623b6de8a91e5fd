// Ground detail: down the tree over columns of tiles, through a tile's groups of instances, into the objects' models.
//
// Each ray for itself: details are met within a few tiles of where a ray comes to the ground. What they are is decoded by
// scene/detail_layer.h, as every backend does.
#if defined(SILVAVIS_NESTED_DETAILS) == defined(HWY_TARGET_TOGGLE)
#ifdef SILVAVIS_NESTED_DETAILS
#undef SILVAVIS_NESTED_DETAILS
#else
#define SILVAVIS_NESTED_DETAILS
#endif

#include "silvavis/accel/nested_ground.h"
#include "silvavis/accel/nested_model.h"
#include "silvavis/scene/detail_ray.h"

HWY_BEFORE_NAMESPACE();
namespace silvavis::accel::HWY_NAMESPACE {

template <bool any_hit>
struct DetailWalk {
  const scene::Scene& scene;
  const scene::DetailLayer& layer;
  std::uint8_t layer_index;
  const Ray& ray;
  double& best;
  Hit& hit;
  bool found = false;

  // A ray in floats that begins anew at a corner near by; its inverse is the same everywhere.
  struct NearRay {
    V3 o;
    float least, most;  // distances from `begin`
    double begin;
  };
  struct Entry {
    float near, far;
    std::uint32_t node;
    std::int32_t level, column, row;
  };

  V3 inverse = V3(HWY_NAMESPACE::inverse(ray.direction.x), HWY_NAMESPACE::inverse(ray.direction.y),
                  HWY_NAMESPACE::inverse(ray.direction.z));

  HWY_INLINE V3 moved(const V3d& corner, double t) const {
    const auto along = [&](double o, double c, float d)
                           HWY_ATTR { return static_cast<float>(o - c + t * static_cast<double>(d)); };
    return {along(ray.origin.x, corner.x, ray.direction.x), along(ray.origin.y, corner.y, ray.direction.y),
            along(ray.origin.z, corner.z, ray.direction.z)};
  }

  HWY_INLINE void walk() {
    if (layer.nodes.empty()) return;
    double near = ray.least, far = best;
    if (layer.fades && (ray.width_m > 0 || ray.spread > 0)) {
      // Where the ray is too wide for all of them.
      const float room = layer.most_faded() - ray.width_m;
      if (room < 0) return;
      if (ray.spread > 0) far = std::min(far, static_cast<double>(room / ray.spread));
    }
    for (int a = 0; a < 3; ++a) {
      constexpr double slack_m = 0.01;
      const double to_least = (layer.least[a] - slack_m - ray.origin[a]) * static_cast<double>(inverse[a]),
                   to_most = (layer.most[a] + slack_m - ray.origin[a]) * static_cast<double>(inverse[a]);
      near = std::max(near, std::min(to_least, to_most));
      far = std::min(far, std::max(to_least, to_most));
    }
    if (near > far) return;
    NearRay local;
    local.begin = near;
    local.o = moved(layer.corner, near);
    local.least = 0;
    local.most = static_cast<float>(std::min(far - near, 1e30)) + 0.01f;
    walk_nodes(local);
  }

  HWY_INLINE float limit(const NearRay& r) const {
    return std::min(r.most, static_cast<float>(std::min(best - r.begin, 1e30)));
  }

  HWY_INLINE void walk_nodes(const NearRay& r) {
    const bool flip_x = ray.direction.x < 0, flip_y = ray.direction.y < 0;
    const std::uint32_t flip = (flip_x ? 3u : 0u) | (flip_y ? 12u : 0u);
    constexpr float slack_m = 0.005f;
    const float margin = layer.margin_m + slack_m;
    HWY_ALIGN static constexpr float columns[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
    HWY_ALIGN static constexpr float rows[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
    Entry stack[16 * 15 + 1];
    int size = 0;
    stack[size++] = {r.least, r.most, 0, layer.levels - 1, 0, 0};
    while (size > 0) {
      const Entry entry = stack[--size];
      const float most = limit(r);
      if (entry.near > most) continue;
      const scene::DetailNode& node = layer.nodes[entry.node];
      const float cell = static_cast<float>(layer.side_m) * static_cast<float>(std::uint64_t{1} << (2 * entry.level));
      const float west = static_cast<float>(entry.column * 4) * cell - r.o.x,
                  south = static_cast<float>(entry.row * 4) * cell - r.o.y;
      const float x_in = (west + (flip_x ? cell + margin : -margin)) * inverse.x,
                  x_out = (west + (flip_x ? -margin : cell + margin)) * inverse.x;
      const float y_in = (south + (flip_y ? cell + margin : -margin)) * inverse.y,
                  y_out = (south + (flip_y ? -margin : cell + margin)) * inverse.y;
      const V8 per_x = hn::Set(f8, cell * inverse.x), per_y = hn::Set(f8, cell * inverse.y);
      HWY_ALIGN float nears[16], fars[16];
      std::uint32_t hits = 0;
      for (std::size_t k = 0; k < 16; k += hn::Lanes(f8)) {
        const V8 to_x = hn::Mul(hn::Load(f8, columns + k), per_x), to_y = hn::Mul(hn::Load(f8, rows + k), per_y);
        const V8 low = hn::Sub(hn::LoadU(f8, node.least_m.data() + k), hn::Set(f8, r.o.z + slack_m)),
                 high = hn::Sub(hn::LoadU(f8, node.most_m.data() + k), hn::Set(f8, r.o.z - slack_m));
        const V8 to_low = hn::Mul(low, hn::Set(f8, inverse.z)), to_high = hn::Mul(high, hn::Set(f8, inverse.z));
        const V8 near = hn::Max(hn::Max(hn::Add(hn::Set(f8, x_in), to_x), hn::Add(hn::Set(f8, y_in), to_y)),
                                hn::Max(hn::Min(to_low, to_high), hn::Set(f8, entry.near)));
        const V8 far = hn::Min(hn::Min(hn::Add(hn::Set(f8, x_out), to_x), hn::Add(hn::Set(f8, y_out), to_y)),
                               hn::Min(hn::Max(to_low, to_high), hn::Set(f8, std::min(entry.far, most))));
        hn::Store(near, f8, nears + k);
        hn::Store(far, f8, fars + k);
        hits |= bits_of(f8, hn::Le(near, far)) << k;
      }
      hits &= node.children;
      std::uint32_t order = turned_bits(hits, flip_x, flip_y);
      // Rising bits are front to back: columns are met at once, nodes are pushed the farthest first.
      while (order != 0) {
        const bool leaf = entry.level == 0;
        const auto next = static_cast<std::uint32_t>(leaf ? std::countr_zero(order) : std::bit_width(order) - 1);
        order ^= 1u << next;
        const std::uint32_t child = next ^ flip;
        const std::uint32_t index =
            node.first + static_cast<std::uint32_t>(std::popcount(node.children & ((1u << child) - 1)));
        const std::int32_t column = entry.column * 4 + static_cast<std::int32_t>(child & 3),
                           row = entry.row * 4 + static_cast<std::int32_t>(child >> 2);
        if (!leaf) {
          stack[size++] = {nears[child], fars[child], index, entry.level - 1, column, row};
          continue;
        }
        if (nears[child] > limit(r)) continue;
        meet_column(index, column, row, r.begin + static_cast<double>(nears[child]), fars[child] - nears[child]);
        if (any_hit && found) return;
      }
    }
  }

  HWY_INLINE void meet_column(std::uint32_t index, std::int32_t column, std::int32_t row, double begin, float length) {
    const std::uint32_t first = layer.columns[index].first_tile, last = layer.columns[index + 1].first_tile;
    const bool down = ray.direction.z < 0;
    for (std::uint32_t k = 0; k < last - first; ++k) {
      const std::uint32_t t = down ? last - 1 - k : first + k;
      const V3d corner(layer.corner.x + column * layer.side_m, layer.corner.y + row * layer.side_m,
                       layer.tiles[t].z * layer.side_m);
      NearRay r;
      r.begin = begin;
      r.o = moved(corner, begin);
      constexpr float slack_m = 0.005f;
      r.least = std::max(0.0f, static_cast<float>(ray.least - begin));
      r.most = length + slack_m;
      meet_tile(t, corner, column, row, r);
      if (any_hit && found) return;
    }
  }

  HWY_INLINE void meet_tile(std::uint32_t t, const V3d& corner, std::int32_t column, std::int32_t row,
                            const NearRay& r) {
    const scene::DetailTile& tile = layer.tiles[t];
    const std::uint32_t groups = layer.tiles[t + 1].first_group - tile.first_group, end = layer.tiles[t + 1].first;
    const std::uint8_t* const bytes = layer.group_bounds.data() + 6 * std::size_t{tile.first_group};
    // Distance to a bound = byte * scale + shift.
    V8 scale[3], shift[3];
    const std::uint8_t *in[3], *out[3];
    for (int a = 0; a < 3; ++a) {
      scale[a] = hn::Set(f8, layer.group_step_m * inverse[a]);
      shift[a] = hn::Set(f8, (layer.group_origin_m - r.o[a]) * inverse[a]);
      const bool turned = ray.direction[a] < 0;
      const auto axis = static_cast<std::size_t>(a);
      in[a] = bytes + (2 * axis + (turned ? 1 : 0)) * groups;
      out[a] = bytes + (2 * axis + (turned ? 0 : 1)) * groups;
    }
    constexpr std::uint32_t most_groups = 64;  // that are put in order
    for (std::uint32_t first = 0; first < groups; first += most_groups) {
      std::uint64_t order[most_groups];
      int count = 0;
      const V8 most = hn::Set(f8, limit(r));
      const std::uint32_t last = std::min(groups, first + most_groups);
      for (std::uint32_t g = first; g < last; g += static_cast<std::uint32_t>(hn::Lanes(f8))) {
        V8 near = hn::Set(f8, r.least), far = most;
        for (int a = 0; a < 3; ++a) {
          near = hn::Max(near, hn::Add(hn::Mul(floats_of(in[a] + g), scale[a]), shift[a]));
          far = hn::Min(far, hn::Add(hn::Mul(floats_of(out[a] + g), scale[a]), shift[a]));
        }
        HWY_ALIGN float nears[8];
        hn::Store(near, f8, nears);
        std::uint32_t hits = bits_of(f8, hn::Le(near, far));
        if (last - g < hn::Lanes(f8)) hits &= (1u << (last - g)) - 1;
        for (; hits != 0; hits &= hits - 1) {
          const auto lane = static_cast<std::uint32_t>(std::countr_zero(hits));
          insert(order, count, 0, waiting(nears[lane], g + lane, false));
        }
      }
      while (count > 0) {
        const std::uint64_t group = order[--count];
        if (distance_of(group) > limit(r)) break;
        const std::uint32_t slot = tile.first + index_of(group) * scene::detail_group;
        meet_group(slot, std::min(scene::detail_group, end - slot), tile.z, corner, column, row, r);
        if (any_hit && found) return;
      }
    }
  }

  HWY_INLINE void meet_group(std::uint32_t slot, std::uint32_t size, std::int32_t z, const V3d& corner,
                             std::int32_t column, std::int32_t row, const NearRay& r) {
    using I8 = hn::Rebind<std::int32_t, F8>;
    const I8 i8;
    std::uint64_t order[scene::detail_group];
    int count = 0;
    const V8 most = hn::Set(f8, limit(r));
    for (std::uint32_t k = 0; k < size; k += static_cast<std::uint32_t>(hn::Lanes(f8))) {
      const auto candidates = hn::PromoteTo(i8, hn::LoadU(hn::Rebind<std::uint16_t, F8>(), &layer.chosen[slot + k]));
      V8 near = hn::Set(f8, r.least), far = most;
      for (int a = 0; a < 3; ++a) {
        const auto axis = static_cast<std::size_t>(a);
        const bool turned = ray.direction[a] < 0;
        const float* const in = turned ? layer.most_m[axis].data() : layer.least_m[axis].data();
        const float* const out = turned ? layer.least_m[axis].data() : layer.most_m[axis].data();
        const V8 o = hn::Set(f8, r.o[a]), per = hn::Set(f8, inverse[a]);
        near = hn::Max(near, hn::Mul(hn::Sub(hn::GatherIndex(f8, in, candidates), o), per));
        far = hn::Min(far, hn::Mul(hn::Sub(hn::GatherIndex(f8, out, candidates), o), per));
      }
      HWY_ALIGN float nears[8];
      hn::Store(near, f8, nears);
      std::uint32_t hits = bits_of(f8, hn::Le(near, far));
      if (size - k < hn::Lanes(f8)) hits &= (1u << (size - k)) - 1;
      for (; hits != 0; hits &= hits - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(hits));
        insert(order, count, 0, waiting(nears[lane], k + lane, false));
      }
    }
    while (count > 0) {
      const std::uint64_t next = order[--count];
      if (distance_of(next) > limit(r)) return;
      meet(slot + index_of(next), z, corner, column, row);
      if (any_hit && found) return;
    }
  }

  HWY_INLINE void meet(std::uint32_t slot, std::int32_t z, const V3d& corner, std::int32_t column, std::int32_t row) {
    const std::uint16_t candidate = layer.chosen[slot];
    const scene::DetailFrame& frame = layer.frames[candidate];
    const scene::LocalRay local = scene::detail_ray(frame, corner, ray.origin, ray.direction);
    std::uint8_t level = 0;
    const scene::PlantModel* model = scene.models[frame.model].get();
    if (ray.width_m > 0 || ray.spread > 0) {
      const float dither = scene::detail_dither(layer.first_x + column, layer.first_y + row, z, candidate);
      const float width = ray.width_m + ray.spread * static_cast<float>(std::max(local.start, 0.0));
      if (layer.fades && scene::is_faded(frame, dither, width)) return;
      level = scene::detail_level(*model, frame, dither, width);
      if (level > 0) model = model->coarser[level - 1u].get();
    }
    const double size = 1.0 / static_cast<double>(frame.scale);
    ModelHit model_hit;
    model_hit.t = static_cast<float>(std::min((best - local.start) * size, 1e30));
    model_hit.t += std::abs(model_hit.t) * 0x1p-22f;
    const auto least = static_cast<float>((ray.least - local.start) * size);
    if (!hit_model<any_hit>(*model, local.origin, local.direction, least, model_hit)) return;
    const double distance = local.start + static_cast<double>(model_hit.t) * static_cast<double>(frame.scale);
    if (distance >= best || distance < ray.least) return;
    best = distance;
    found = true;
    hit = Hit{};
    hit.distance = distance;
    hit.surface = Surface::detail;
    hit.layer = layer_index;
    hit.column = layer.first_x + column;
    hit.row = layer.first_y + row;
    hit.site_slot = slot;
    hit.model = frame.model;
    hit.level = level;
    hit.slot = model_hit.slot;
    hit.u = model_hit.u;
    hit.v = model_hit.v;
  }
};

// Meets what is nearer than `best`; any_hit: whatever is.
template <bool any_hit>
HWY_NOINLINE bool meet_details(const scene::Scene& scene, const Ray& ray, double& best, Hit& hit) {
  bool found = false;
  for (std::size_t k = 0; k < scene.details.size(); ++k) {
    DetailWalk<any_hit> walk{scene, scene.details[k], static_cast<std::uint8_t>(k), ray, best, hit};
    walk.walk();
    found = found || walk.found;
    if (any_hit && found) break;
  }
  return found;
}

}  // namespace silvavis::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
