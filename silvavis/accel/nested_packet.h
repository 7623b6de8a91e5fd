// Sixteen neighbouring rays down one model's tree, as far as they keep together.
//
// Intervals that hold every ray say which boxes any of them may enter, and the rays themselves are asked only there. Where fewer
// than a handful are left, each goes on by itself. Each ray meets to the last bit what it would meet alone, since what is met
// hangs on no order (nested_model.h).
// Source: interval arithmetic over packets, Boulos, Wald and Shirley 2006.
#if defined(SILVAVIS_NESTED_PACKET) == defined(HWY_TARGET_TOGGLE)
#ifdef SILVAVIS_NESTED_PACKET
#undef SILVAVIS_NESTED_PACKET
#else
#define SILVAVIS_NESTED_PACKET
#endif

#include "silvavis/accel/nested_model.h"

HWY_BEFORE_NAMESPACE();
namespace silvavis::accel::HWY_NAMESPACE {

constexpr std::size_t packet_size = 16;
constexpr int together_least = 3;  // fewer go alone

// The least and greatest of what rays have on an axis; their directions have one sign.
struct Interval {
  float least = 1e30f, most = -1e30f;
  HWY_INLINE void add(float x) {
    least = std::min(least, x);
    most = std::max(most, x);
  }
};

// (bound - origin) * inverse for any origin and inverse of the intervals: the least at the near bound, the greatest at the far
// one. Rounding keeps order, so they hold for each ray's own result.
struct IntervalSlab {
  V8 origin_in, origin_out, inverse_least, inverse_most;

  HWY_INLINE IntervalSlab(const Interval& origin, const Interval& inverse)
      : origin_in(hn::Set(f8, inverse.least < 0 ? origin.least : origin.most)),
        origin_out(hn::Set(f8, inverse.least < 0 ? origin.most : origin.least)),
        inverse_least(hn::Set(f8, inverse.least)),
        inverse_most(hn::Set(f8, inverse.most)) {}
  HWY_INLINE V8 in(V8 bound) const {
    const V8 way = hn::Sub(bound, origin_in);
    return hn::Min(hn::Mul(way, inverse_least), hn::Mul(way, inverse_most));
  }
  HWY_INLINE V8 out(V8 bound) const {
    const V8 way = hn::Sub(bound, origin_out);
    return hn::Max(hn::Mul(way, inverse_least), hn::Mul(way, inverse_most));
  }
};

// Rays in a model's space, lane by lane.
struct ModelPacket {
  HWY_ALIGN float origin[3][packet_size] = {};
  HWY_ALIGN float inverse[3][packet_size] = {};
  HWY_ALIGN float slack[3][packet_size] = {};
  HWY_ALIGN float most[packet_size];       // no hit beyond it counts; below all for rays that are through
  HWY_ALIGN float from[packet_size] = {};  // where they enter the hull
  V3 origins[packet_size], directions[packet_size];
  float least[packet_size];
  ModelHit hits[packet_size];
  std::uint32_t active = 0, found = 0;

  HWY_INLINE ModelPacket() { std::fill_n(most, packet_size, -1e30f); }
  HWY_INLINE void set(std::size_t i, const scene::PlantModel& model, const V3& o, const V3& d) {
    const BoxRay ray(model, o, d);
    origins[i] = o;
    directions[i] = d;
    for (int a = 0; a < 3; ++a) {
      origin[a][i] = o[a];
      inverse[a][i] = ray.inverse[a];
      slack[a][i] = ray.slack[a];
    }
    most[i] = hits[i].t;
  }
};

template <bool any_hit>
HWY_INLINE void walk_alone(const scene::PlantModel& model, ModelPacket& packet, std::uint32_t rays, std::uint64_t entry,
                           const float* nears) {
  for (; rays != 0; rays &= rays - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(rays));
    if (!walk_model<any_hit>(model, packet.origins[i], packet.directions[i], packet.least[i],
                             waiting(nears[i], index_of(entry), is_leaf(entry)), packet.hits[i]))
      continue;
    packet.found |= 1u << i;
    packet.most[i] = any_hit ? -1e30f : packet.hits[i].t;
  }
}

// As walk_model() for each ray of packet.active, which have entered the hull.
template <bool any_hit>
HWY_INLINE void walk_together(const scene::PlantModel& model, ModelPacket& packet) {
  Interval origins[3], inverses[3];
  float slacks[3] = {0, 0, 0}, first = 1e30f;
  for (std::uint32_t rays = packet.active; rays != 0; rays &= rays - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(rays));
    for (std::size_t a = 0; a < 3; ++a) {
      origins[a].add(packet.origin[a][i]);
      inverses[a].add(packet.inverse[a][i]);
      slacks[a] = std::max(slacks[a], packet.slack[a][i]);
    }
    first = std::min(first, packet.from[i]);
  }
  for (const Interval& inverse : inverses) {
    // Rays that part at an axis see a node's sides in another order.
    if (inverse.least < 0 && inverse.most > 0)
      return walk_alone<any_hit>(model, packet, packet.active, waiting(first, 0, false), packet.from);
  }
  const IntervalSlab slabs[3] = {{origins[0], inverses[0]}, {origins[1], inverses[1]}, {origins[2], inverses[2]}};

  struct Entry {
    HWY_ALIGN float nears[packet_size];  // of each ray; no sooner than the parents'
    std::uint64_t what;
    std::uint32_t rays;
  };
  Entry stack[scene::most_depth * (scene::node_size - 1) + 1];
  int size = 1;
  std::copy_n(packet.from, packet_size, stack[0].nears);
  stack[0].what = waiting(first, 0, false);
  stack[0].rays = packet.active;
  while (size > 0) {
    const Entry& top = stack[--size];
    std::uint32_t rays = 0;
    for (std::size_t k = 0; k < packet_size; k += hn::Lanes(f8))
      rays |= bits_of(f8, hn::Le(hn::Load(f8, top.nears + k), hn::Load(f8, packet.most + k))) << k;
    rays &= top.rays;
    if (rays == 0) continue;
    if (std::popcount(rays) < together_least) {
      walk_alone<any_hit>(model, packet, rays, top.what, top.nears);
      continue;
    }
    if (is_leaf(top.what)) {
      const DecodedCorners corners({model.blocks[index_of(top.what)], hn::Set(f8, model.step_m)});
      for (; rays != 0; rays &= rays - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(rays));
        if (!hit_block<any_hit>(model, index_of(top.what), corners, packet.origins[i], packet.directions[i],
                                packet.least[i], top.nears[i], packet.hits[i]))
          continue;
        packet.found |= 1u << i;
        packet.most[i] = any_hit ? -1e30f : packet.hits[i].t;
      }
      continue;
    }
    const Entry parent = top;
    const scene::TreeNode& node = model.nodes[index_of(parent.what)];
    const std::uint8_t *bytes_in[3], *bytes_out[3];
    V8 most = hn::Set(f8, -1e30f);
    for (std::size_t k = 0; k < packet_size; k += hn::Lanes(f8)) most = hn::Max(most, hn::Load(f8, packet.most + k));
    most = hn::MaxOfLanes(f8, most);
    HWY_ALIGN float nears[16];
    std::uint32_t hits = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      bytes_in[a] = inverses[a].least < 0 ? node.most[a].data() : node.least[a].data();
      bytes_out[a] = inverses[a].least < 0 ? node.least[a].data() : node.most[a].data();
    }
    for (std::size_t k = 0; k < 16; k += hn::Lanes(f8)) {
      V8 near = hn::Set(f8, distance_of(parent.what)), far = most;
      for (std::size_t a = 0; a < 3; ++a) {
        const V8 step = hn::Set(f8, node.step(a)), origin = hn::Set(f8, node.origin[a]);
        // Twice the slack: once for each way to reckon.
        const V8 slack = hn::Set(f8, 2 * slacks[a]);
        near = hn::Max(near, hn::Sub(slabs[a].in(hn::Add(hn::Mul(floats_of(bytes_in[a] + k), step), origin)), slack));
        far = hn::Min(far, hn::Add(slabs[a].out(hn::Add(hn::Mul(floats_of(bytes_out[a] + k), step), origin)), slack));
      }
      hn::Store(near, f8, nears + k);
      hits |= bits_of(f8, hn::Le(near, far)) << k;
    }
    hits &= static_cast<std::uint32_t>(node.inner | node.leaves);
    if (hits == 0) continue;

    // The farthest first.
    std::uint64_t order[scene::node_size];
    int count = 0;
    for (; hits != 0; hits &= hits - 1) {
      const auto child = static_cast<std::uint32_t>(std::countr_zero(hits));
      insert(order, count, 0, waiting(nears[child], child, node.leaves >> child & 1));
    }
    // Each ray's own distances to bounds = byte * scale + shift, as in walk_model().
    HWY_ALIGN float scales[3][packet_size], shifts_in[3][packet_size], shifts_out[3][packet_size];
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t k = 0; k < packet_size; k += hn::Lanes(f8)) {
        const V8 inverse = hn::Load(f8, packet.inverse[a] + k), slack = hn::Load(f8, packet.slack[a] + k);
        const V8 shift = hn::Mul(hn::Sub(hn::Set(f8, node.origin[a]), hn::Load(f8, packet.origin[a] + k)), inverse);
        hn::Store(hn::Mul(hn::Set(f8, node.step(a)), inverse), f8, scales[a] + k);
        hn::Store(hn::Sub(shift, slack), f8, shifts_in[a] + k);
        hn::Store(hn::Add(shift, slack), f8, shifts_out[a] + k);
      }
    }
    for (int at = 0; at < count; ++at) {
      const std::uint32_t child = index_of(order[at]);
      Entry& entry = stack[size];
      std::uint32_t entering = 0;
      V8 in[3], out[3];
      for (std::size_t a = 0; a < 3; ++a) {
        in[a] = hn::Set(f8, static_cast<float>(bytes_in[a][child]));
        out[a] = hn::Set(f8, static_cast<float>(bytes_out[a][child]));
      }
      for (std::size_t k = 0; k < packet_size; k += hn::Lanes(f8)) {
        V8 near = hn::Load(f8, parent.nears + k), far = hn::Load(f8, packet.most + k);
        for (std::size_t a = 0; a < 3; ++a) {
          const V8 scale = hn::Load(f8, scales[a] + k);
          near = hn::Max(near, hn::Add(hn::Mul(in[a], scale), hn::Load(f8, shifts_in[a] + k)));
          far = hn::Min(far, hn::Add(hn::Mul(out[a], scale), hn::Load(f8, shifts_out[a] + k)));
        }
        hn::Store(near, f8, entry.nears + k);
        entering |= bits_of(f8, hn::Le(near, far)) << k;
      }
      entry.rays = entering & rays;
      if (entry.rays == 0) continue;
      const std::uint32_t below = (1u << child) - 1;
      const bool leaf = is_leaf(order[at]);
      const std::uint32_t index =
          leaf ? node.first_block + static_cast<std::uint32_t>(std::popcount(node.leaves & below))
               : node.first_node + static_cast<std::uint32_t>(std::popcount(node.inner & below));
      leaf ? prefetch_block(model, index) : prefetch_node(model, index);
      entry.what = waiting(distance_of(order[at]), index, leaf);
      ++size;
    }
  }
}

}  // namespace silvavis::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
