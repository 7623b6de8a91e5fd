// Sixteen neighbouring rays through a tile position, as far as they keep together: the same boxes of sites, the same plants.
//
// What nested_sites.h asks for one ray is asked here by intervals that hold them all, then with rays in the lanes instead of sites.
#if defined(SILVAVIS_NESTED_PACKET_SITES) == defined(HWY_TARGET_TOGGLE)
#ifdef SILVAVIS_NESTED_PACKET_SITES
#undef SILVAVIS_NESTED_PACKET_SITES
#else
#define SILVAVIS_NESTED_PACKET_SITES
#endif

#include "silvavis/accel/nested_packet.h"
#include "silvavis/accel/nested_sites.h"

HWY_BEFORE_NAMESPACE();
namespace silvavis::accel::HWY_NAMESPACE {

// Neighbouring rays on their way through one layer.
template <bool any_hit>
struct PacketWalk {
  const scene::Scene& scene;
  const scene::PlantLayer& layer;
  LayerWalk<any_hit>* walks;  // one a ray

  using TileRay = typename LayerWalk<any_hit>::TileRay;

  // Rays in a tile, lane by lane: what LayerWalk::cross_leaf() needs of each.
  struct TilePacket {
    HWY_ALIGN float x[packet_size] = {}, y[packet_size] = {}, z[packet_size] = {};
    HWY_ALIGN float hx[packet_size] = {}, hy[packet_size] = {}, per_run[packet_size] = {}, dz[packet_size] = {};
    HWY_ALIGN float least[packet_size] = {}, most[packet_size];  // most: below all for rays that are through
    TileRay rays[packet_size];
    Interval all_x, all_y, inverse_x, inverse_y;
    float first = 1e30f;  // the least of `least`

    HWY_INLINE TilePacket() { std::fill_n(most, packet_size, -1e30f); }
    HWY_INLINE void set(std::size_t i, const FlatRay& flat, const TileRay& ray) {
      rays[i] = ray;
      x[i] = ray.x;
      y[i] = ray.y;
      z[i] = ray.z;
      dz[i] = flat.dz;
      least[i] = ray.least;
      hx[i] = flat.ahead_x;
      hy[i] = flat.ahead_y;
      per_run[i] = flat.per_run;
      all_x.add(ray.x);
      all_y.add(ray.y);
      inverse_x.add(flat.ix);
      inverse_y.add(flat.iy);
      first = std::min(first, ray.least);
    }
    HWY_INLINE float greatest_most() const {
      V8 greatest = hn::Load(f8, most);
      for (std::size_t k = hn::Lanes(f8); k < packet_size; k += hn::Lanes(f8))
        greatest = hn::Max(greatest, hn::Load(f8, most + k));
      return hn::GetLane(hn::MaxOfLanes(f8, greatest));
    }
  };

  // As LayerWalk::meet_tile() for these rays.
  HWY_INLINE void meet_tile(int column, int row, std::uint32_t rays, const PyramidEntry* boxes) {
    const std::size_t position = layer.position(column, row);
    const scene::TileSites& tile = layer.tile_sites[layer.tiles[position]];
    if (tile.count == 0) return;
    TilePacket packet;
    for (; rays != 0; rays &= rays - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(rays));
      const TileRay ray = walks[i].ray_in_tile(column, row, boxes[i]);
      if (ray.least > ray.most) continue;
      packet.set(i, walks[i].flat, ray);
      packet.most[i] = walks[i].limit(ray);
    }
    const IntervalSlab x(packet.all_x, packet.inverse_x), y(packet.all_y, packet.inverse_y);
    const bool flip_x = packet.inverse_x.least < 0, flip_y = packet.inverse_y.least < 0;
    std::uint64_t stack[8 * 15 + 1];
    int size = 0;
    stack[size++] = waiting(packet.first, 0, false);
    while (size > 0) {
      const std::uint64_t entry = stack[--size];
      const float most = packet.greatest_most();
      if (distance_of(entry) > most) continue;
      HWY_ALIGN float nears[16];
      // Bits of the boxes that any ray may cross.
      const auto crossed = [&](const float* least_x, const float* most_x, const float* least_y, const float* most_y,
                               std::size_t count) HWY_ATTR {
        std::uint32_t hits = 0;
        for (std::size_t k = 0; k < count; k += hn::Lanes(f8)) {
          const V8 west = hn::LoadU(f8, least_x + k), east = hn::LoadU(f8, most_x + k),
                   south = hn::LoadU(f8, least_y + k), north = hn::LoadU(f8, most_y + k);
          const V8 near =
              hn::Max(hn::Max(x.in(flip_x ? east : west), y.in(flip_y ? north : south)), hn::Set(f8, packet.first));
          const V8 far =
              hn::Min(hn::Min(x.out(flip_x ? west : east), y.out(flip_y ? south : north)), hn::Set(f8, most));
          hn::Store(near, f8, nears + k);
          hits |= bits_of(f8, hn::And(hn::Le(near, far), hn::Le(west, east))) << k;
        }
        return hits;
      };
      if (is_leaf(entry)) {
        const scene::SiteLeaf leaf = scene::SiteLeaf::of(index_of(entry));
        const std::size_t slot0 = leaf.first_slot;
        HWY_ALIGN float bounds[4][16];
        for (std::size_t k = 0; k < leaf.slots; k += hn::Lanes(f8)) {
          const V8 east = hn::LoadU(f8, tile.x_m.data() + slot0 + k),
                   north = hn::LoadU(f8, tile.y_m.data() + slot0 + k);
          // A hair wider than the circle, for rounding.
          const V8 reach = hn::Mul(hn::LoadU(f8, tile.reach_m.data() + slot0 + k), hn::Set(f8, 1.0001f));
          hn::Store(hn::Sub(east, reach), f8, bounds[0] + k);
          hn::Store(hn::Add(east, reach), f8, bounds[1] + k);
          hn::Store(hn::Sub(north, reach), f8, bounds[2] + k);
          hn::Store(hn::Add(north, reach), f8, bounds[3] + k);
        }
        const std::uint32_t sites = crossed(bounds[0], bounds[1], bounds[2], bounds[3], leaf.slots);
        if (sites != 0) meet_leaf(tile, position, column, row, packet, slot0, sites);
        continue;
      }
      const scene::SiteNode& node = tile.nodes[index_of(entry)];
      const int bottom = size;
      for (std::uint32_t hits =
               crossed(node.least_x.data(), node.most_x.data(), node.least_y.data(), node.most_y.data(), 16);
           hits != 0; hits &= hits - 1) {
        const auto child = static_cast<std::uint32_t>(std::countr_zero(hits));
        insert(stack, size, bottom, waiting(nears[child], node.children[child], node.above_leaves));
      }
    }
  }

  // As LayerWalk::walk_leaf(), with rays in the lanes instead of sites.
  HWY_INLINE void meet_leaf(const scene::TileSites& tile, std::size_t position, int column, int row, TilePacket& packet,
                            std::size_t slot0, std::uint32_t sites) {
    const std::uint8_t* const species = layer.plant_species.data() + layer.first_slot[position] + slot0;
    const std::uint16_t* const heights = layer.plant_heights.data() + layer.first_slot[position] + slot0;
    HWY_ALIGN float nears[16][packet_size];
    std::uint32_t crossing[16], order[16];
    float firsts[16];
    int plants = 0;
    const V8 zero = hn::Zero(f8);
    for (; sites != 0; sites &= sites - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(sites));
      if (species[lane] == scene::no_species) continue;
      const float radius = tile.radius_m[slot0 + lane], reach = tile.reach_m[slot0 + lane];
      const scene::SpeciesModels& kind = layer.species[species[lane]];
      const V8 own_reach = hn::Set(f8, radius * kind.most_reach + site_slack_m);
      const float foot = layer.base_m[position] + layer.step_m[position] * static_cast<float>(heights[lane]);
      const float tip = foot + (radius * kind.most_height + site_slack_m),
                  root = foot + (radius * layer.least_height - site_slack_m);
      std::uint32_t hits = 0;
      V8 first = hn::Set(f8, 1e30f);
      for (std::size_t k = 0; k < packet_size; k += hn::Lanes(f8)) {
        const V8 hx = hn::Load(f8, packet.hx + k), hy = hn::Load(f8, packet.hy + k),
                 per_run = hn::Load(f8, packet.per_run + k), dz = hn::Load(f8, packet.dz + k),
                 z = hn::Load(f8, packet.z + k);
        const V8 px = hn::Sub(hn::Set(f8, tile.x_m[slot0 + lane]), hn::Load(f8, packet.x + k));
        const V8 py = hn::Sub(hn::Set(f8, tile.y_m[slot0 + lane]), hn::Load(f8, packet.y + k));
        const V8 along = hn::Add(hn::Mul(px, hx), hn::Mul(py, hy));
        const V8 beside = hn::Sub(hn::Mul(px, hy), hn::Mul(py, hx));
        const V8 square = hn::Sub(hn::Set(f8, reach * reach), hn::Mul(beside, beside));
        const V8 chord = hn::Sqrt(hn::Max(square, zero));
        const V8 near = hn::Max(hn::Mul(hn::Sub(along, chord), per_run), hn::Load(f8, packet.least + k));
        const V8 far = hn::Min(hn::Mul(hn::Add(along, chord), per_run), hn::Load(f8, packet.most + k));
        const V8 z_in = hn::Add(z, hn::Mul(dz, near)), z_out = hn::Add(z, hn::Mul(dz, far));
        auto crossed = hn::And(hn::Ge(square, zero), hn::Le(near, far));
        crossed = hn::And(crossed, hn::Le(hn::Abs(beside), own_reach));
        crossed = hn::And(crossed, hn::Le(hn::Min(z_in, z_out), hn::Set(f8, tip)));
        crossed = hn::And(crossed, hn::Ge(hn::Max(z_in, z_out), hn::Set(f8, root)));
        hn::Store(near, f8, nears[lane] + k);
        first = hn::Min(first, hn::IfThenElse(crossed, near, first));
        hits |= bits_of(f8, crossed) << k;
      }
      if (hits == 0 || reach <= 0) continue;
      crossing[lane] = hits;
      firsts[lane] = hn::GetLane(hn::MinOfLanes(f8, first));
      // The nearest first.
      int at = plants++;
      for (; at > 0 && firsts[order[at - 1]] > firsts[lane]; --at) order[at] = order[at - 1];
      order[at] = lane;
    }
    for (int n = 0; n < plants; ++n) {
      const std::uint32_t lane = order[n];
      std::uint32_t still = 0;
      for (std::size_t k = 0; k < packet_size; k += hn::Lanes(f8))
        still |= bits_of(f8, hn::Le(hn::Load(f8, nears[lane] + k), hn::Load(f8, packet.most + k))) << k;
      still &= crossing[lane];
      if (still == 0) continue;
      meet_plant(column, row, static_cast<std::uint32_t>(slot0) + lane, species[lane], still);
      for (; still != 0; still &= still - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(still));
        packet.most[i] = any_hit && walks[i].found ? -1e30f : walks[i].limit(packet.rays[i]);
      }
    }
  }

  HWY_INLINE void meet_plant(int column, int row, std::uint32_t slot, std::uint8_t species, std::uint32_t rays) {
    if (std::popcount(rays) < together_least) {
      for (; rays != 0; rays &= rays - 1) walks[std::countr_zero(rays)].meet_plant(column, row, slot, species);
      return;
    }
    const scene::Instance plant = scene::instance_at(scene, layer, column, row, slot, species);
    const scene::PlantModel& full = *scene.models[plant.model];
    scene::LocalRay local[packet_size];
    const scene::PlantModel* model = nullptr;
    std::uint8_t level = 0;
    ModelPacket packet;
    for (; rays != 0; rays &= rays - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(rays));
      LayerWalk<any_hit>& walk = walks[i];
      if (walk.is_left(column, row, slot)) continue;
      local[i] = scene::local_ray(plant, walk.ray.origin, walk.ray.direction);
      const std::uint8_t own_level = walk.level_of(plant, local[i]);
      if (scene::is_impostor(full, own_level) || (model && own_level != level)) {
        walk.meet_plant(column, row, slot, species);
        continue;
      }
      level = own_level;
      model = level == 0 ? &full : full.coarser[level - 1u].get();
      walk.begin_model(plant, local[i], packet.least[i], packet.hits[i]);
      packet.from[i] = packet.least[i];
      float to = packet.hits[i].t;
      if (!cross_hull(model->hull, local[i].origin, local[i].direction, packet.from[i], to)) continue;
      packet.set(i, *model, local[i].origin, local[i].direction);
      packet.active |= 1u << i;
    }
    if (packet.active == 0) return;
    walk_together<any_hit>(*model, packet);
    for (; packet.found != 0; packet.found &= packet.found - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(packet.found));
      walks[i].keep_nearer(plant, local[i], column, row, slot, species, level, packet.hits[i]);
    }
  }
};

}  // namespace silvavis::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
