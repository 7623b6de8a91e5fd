// One plant's model: its hull, its tree, its triangles. All in the model's own space.
#if defined(SILVAVIS_NESTED_MODEL) == defined(HWY_TARGET_TOGGLE)
#ifdef SILVAVIS_NESTED_MODEL
#undef SILVAVIS_NESTED_MODEL
#else
#define SILVAVIS_NESTED_MODEL
#endif

#include <hwy/cache_control.h>

#include "silvavis/accel/nested_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace silvavis::accel::HWY_NAMESPACE {

struct ModelHit {
  float t = 0;  // in: no hit beyond it counts
  float u = 0, v = 0;
  std::uint32_t slot = 0;
};

// Where the ray is within the hull's cylinders: narrows [least, most], false where it is nowhere.
HWY_INLINE bool cross_hull(const scene::Hull& hull, const V3& o, const V3& d, float& least, float& most) {
  const float a = std::max(d.x * d.x + d.y * d.y, 1e-12f), b = o.x * d.x + o.y * d.y, c = o.x * o.x + o.y * o.y;
  const float per_a = 1.0f / a, iz = inverse(d.z);
  HWY_ALIGN float nears[8], fars[8];
  std::uint32_t hits = 0;
  for (std::size_t k = 0; k < 8; k += hn::Lanes(f8)) {
    const V8 radius = hn::LoadU(f8, hull.radii_m.data() + k);
    const V8 square = hn::Add(hn::Set(f8, b * b - a * c), hn::Mul(hn::Set(f8, a), hn::Mul(radius, radius)));
    const V8 chord = hn::Sqrt(hn::Max(square, hn::Zero(f8)));
    const V8 z0 = hn::Mul(hn::Sub(hn::LoadU(f8, hull.edges_m.data() + k), hn::Set(f8, o.z)), hn::Set(f8, iz));
    const V8 z1 = hn::Mul(hn::Sub(hn::LoadU(f8, hull.edges_m.data() + k + 1), hn::Set(f8, o.z)), hn::Set(f8, iz));
    const V8 near = hn::Max(hn::Max(hn::Mul(hn::Sub(hn::Set(f8, -b), chord), hn::Set(f8, per_a)), hn::Min(z0, z1)),
                            hn::Set(f8, least));
    const V8 far = hn::Min(hn::Min(hn::Mul(hn::Add(hn::Set(f8, -b), chord), hn::Set(f8, per_a)), hn::Max(z0, z1)),
                           hn::Set(f8, most));
    hn::Store(near, f8, nears + k);
    hn::Store(far, f8, fars + k);
    hits |= bits_of(f8, hn::And(hn::Le(near, far), hn::And(hn::Ge(square, hn::Zero(f8)), hn::Gt(radius, hn::Zero(f8)))))
            << k;
  }
  if (hits == 0) return false;
  float in = most, out = least;
  for (; hits != 0; hits &= hits - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(hits));
    in = std::min(in, nears[k]);
    out = std::max(out, fars[k]);
  }
  least = in;
  most = out;
  return true;
}

// Eight triangles at once (Möller and Trumbore 1997). Keeps the nearest that is no hole; of equally near ones that of the
// lowest slot. None counts as nearer than `near`, where the ray enters the block's box: so a box may be left out as soon as a
// nearer hit is known, and what is met hangs on no order.
// `corners`(corner, axis, lane): step times what the block stores, of as many lanes as a vector has.
template <bool any_hit, typename Corners>
HWY_INLINE bool hit_block(const scene::PlantModel& model, std::uint32_t block_index, const Corners& corners,
                          const V3& o, const V3& d, float least, float near, ModelHit& hit) {
  const scene::TriangleBlock& block = model.blocks[block_index];
  HWY_ALIGN float ts[8], us[8], vs[8], dets[8];
  std::uint32_t hits = 0;
  const V8 bx = hn::Set(f8, model.origin.x - o.x), by = hn::Set(f8, model.origin.y - o.y),
           bz = hn::Set(f8, model.origin.z - o.z);
  const V8 dx = hn::Set(f8, d.x), dy = hn::Set(f8, d.y), dz = hn::Set(f8, d.z);
  const V8 zero = hn::Zero(f8);
  for (std::size_t k = 0; k < 8; k += hn::Lanes(f8)) {
    const auto corner = [&](std::size_t c, std::size_t axis, V8 base)
                            HWY_ATTR { return hn::Add(base, corners(c, axis, k)); };
    const V8 ax = corner(0, 0, bx), ay = corner(0, 1, by), az = corner(0, 2, bz);
    const V8 e1x = hn::Sub(corner(1, 0, bx), ax), e1y = hn::Sub(corner(1, 1, by), ay),
             e1z = hn::Sub(corner(1, 2, bz), az);
    const V8 e2x = hn::Sub(corner(2, 0, bx), ax), e2y = hn::Sub(corner(2, 1, by), ay),
             e2z = hn::Sub(corner(2, 2, bz), az);
    const V8 px = hn::Sub(hn::Mul(dy, e2z), hn::Mul(dz, e2y));
    const V8 py = hn::Sub(hn::Mul(dz, e2x), hn::Mul(dx, e2z));
    const V8 pz = hn::Sub(hn::Mul(dx, e2y), hn::Mul(dy, e2x));
    const V8 det = hn::Add(hn::Add(hn::Mul(e1x, px), hn::Mul(e1y, py)), hn::Mul(e1z, pz));
    const V8 qx = hn::Sub(hn::Mul(az, e1y), hn::Mul(ay, e1z));
    const V8 qy = hn::Sub(hn::Mul(ax, e1z), hn::Mul(az, e1x));
    const V8 qz = hn::Sub(hn::Mul(ay, e1x), hn::Mul(ax, e1y));
    // The ray begins at the origin: the corner's way to it is -a. Most are ruled out before the division.
    const V8 minus_u = hn::Add(hn::Add(hn::Mul(ax, px), hn::Mul(ay, py)), hn::Mul(az, pz));
    const V8 plain_v = hn::Add(hn::Add(hn::Mul(dx, qx), hn::Mul(dy, qy)), hn::Mul(dz, qz));
    const V8 sign = hn::And(det, hn::SignBit(f8)), size = hn::Abs(det);
    const V8 signed_u = hn::Neg(hn::Xor(minus_u, sign)), signed_v = hn::Xor(plain_v, sign);
    auto inside = hn::And(hn::Ge(signed_u, zero), hn::Ge(signed_v, zero));
    inside = hn::And(inside, hn::Le(hn::Add(signed_u, signed_v), hn::Mul(size, hn::Set(f8, 1.00001f))));
    if (hn::AllFalse(f8, inside)) continue;
    const V8 inverse_det = hn::Div(hn::Set(f8, 1.0f), det);
    const V8 u = hn::Neg(hn::Mul(minus_u, inverse_det)), v = hn::Mul(plain_v, inverse_det);
    const V8 plain_t = hn::Mul(hn::Add(hn::Add(hn::Mul(e2x, qx), hn::Mul(e2y, qy)), hn::Mul(e2z, qz)), inverse_det);
    const V8 t = hn::Max(plain_t, hn::Set(f8, near));
    inside = hn::And(inside, hn::Le(hn::Add(u, v), hn::Set(f8, 1.0f)));
    inside = hn::And(inside, hn::And(hn::Ge(plain_t, hn::Set(f8, least)), hn::Le(t, hn::Set(f8, hit.t))));
    inside = hn::And(inside, hn::Ne(det, zero));
    hn::Store(t, f8, ts + k);
    hn::Store(u, f8, us + k);
    hn::Store(v, f8, vs + k);
    hn::Store(det, f8, dets + k);
    hits |= bits_of(f8, inside) << k;
  }
  bool found = false;
  for (; hits != 0; hits &= hits - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(hits));
    const std::uint32_t slot = block_index * scene::block_size + lane;
    if (ts[lane] > hit.t || (ts[lane] == hit.t && slot >= hit.slot)) continue;
    if (dets[lane] < 0 && !model.looks->cutouts[block.materials[lane]].two_sided) continue;
    if (scene::is_hole(model, slot, us[lane], vs[lane])) continue;
    hit = {ts[lane], us[lane], vs[lane], slot};
    found = true;
    if (any_hit) return true;
  }
  return found;
}

// The corners of a block as it lies there.
struct StoredCorners {
  const scene::TriangleBlock& block;
  V8 step;
  HWY_INLINE V8 operator()(std::size_t corner, std::size_t axis, std::size_t k) const {
    return hn::Mul(step, floats_of(block.corners[corner][axis].data() + k));
  }
};

// The same numbers, made once for several rays.
struct DecodedCorners {
  HWY_ALIGN float at[3][3][scene::block_size];

  HWY_INLINE explicit DecodedCorners(const StoredCorners& from) {
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t k = 0; k < scene::block_size; k += hn::Lanes(f8))
          hn::Store(from(c, axis, k), f8, at[c][axis] + k);
  }
  HWY_INLINE V8 operator()(std::size_t corner, std::size_t axis, std::size_t k) const {
    return hn::Load(f8, at[corner][axis] + k);
  }
};

HWY_INLINE void prefetch_node(const scene::PlantModel& model, std::uint32_t index) {
  const auto* node = reinterpret_cast<const std::uint8_t*>(&model.nodes[index]);
  hwy::Prefetch(node);
  hwy::Prefetch(node + 64);
}
HWY_INLINE void prefetch_block(const scene::PlantModel& model, std::uint32_t index) {
  const auto* block = reinterpret_cast<const std::uint8_t*>(&model.blocks[index]);
  for (int line = 0; line < 4; ++line) hwy::Prefetch(block + line * 64);
}

// The bounds of a node's children on one axis, as distances.
struct Slab {
  const std::uint8_t *least, *most;  // the nearer, the farther
  V8 scale, shift_in, shift_out;

  HWY_INLINE V8 in(std::size_t k) const { return hn::Add(hn::Mul(floats_of(least + k), scale), shift_in); }
  HWY_INLINE V8 out(std::size_t k) const { return hn::Add(hn::Mul(floats_of(most + k), scale), shift_out); }
};

// A ray against the boxes of a model's nodes. `slack`: what rounding may do to a distance, a part in 2^21 of the greatest number
// that comes in (Ize 2013); boxes grow by it, so that none is entered later than what it holds is met.
struct BoxRay {
  V3 o, inverse, slack;
  BoxRay(const scene::PlantModel& model, const V3& origin, const V3& d)
      : o(origin), inverse(HWY_NAMESPACE::inverse(d.x), HWY_NAMESPACE::inverse(d.y), HWY_NAMESPACE::inverse(d.z)) {
    const float extent = std::max({model.reach_m, std::abs(model.least.z), std::abs(model.most.z)});
    for (int a = 0; a < 3; ++a) slack[a] = (std::abs(o[a]) + extent) * std::abs(inverse[a]) * 0x1p-21f;
  }
};

// From one node on. A child counts as entered no sooner than its parents.
template <bool any_hit>
HWY_INLINE bool walk_model(const scene::PlantModel& model, const V3& o, const V3& d, float least, std::uint64_t entry,
                           ModelHit& hit) {
  // Each level leaves at most fifteen behind.
  std::uint64_t stack[scene::most_depth * (scene::node_size - 1) + 1];
  int size = 0;
  bool found = false;
  const BoxRay ray(model, o, d);
  const V8 step = hn::Set(f8, model.step_m);
  for (;;) {
    const float from = distance_of(entry);
    std::uint32_t hits = 0;
    if (from <= hit.t) {
      if (is_leaf(entry)) {
        if (hit_block<any_hit>(model, index_of(entry), StoredCorners{model.blocks[index_of(entry)], step}, o, d, least,
                               from, hit)) {
          found = true;
          if (any_hit) return true;
        }
      } else {
        const scene::TreeNode& node = model.nodes[index_of(entry)];
        HWY_ALIGN float nears[16];
        // Distance to a bound = byte * scale + shift.
        const auto bounds_of = [&](std::size_t axis, int a) HWY_ATTR {
          const bool turned = ray.inverse[a] < 0;
          const float scale = node.step(axis) * ray.inverse[a], shift = (node.origin[axis] - o[a]) * ray.inverse[a];
          return Slab{turned ? node.most[axis].data() : node.least[axis].data(),
                      turned ? node.least[axis].data() : node.most[axis].data(), hn::Set(f8, scale),
                      hn::Set(f8, shift - ray.slack[a]), hn::Set(f8, shift + ray.slack[a])};
        };
        const Slab x = bounds_of(0, 0), y = bounds_of(1, 1), z = bounds_of(2, 2);
        for (std::size_t k = 0; k < 16; k += hn::Lanes(f8)) {
          const V8 near = hn::Max(hn::Max(x.in(k), y.in(k)), hn::Max(z.in(k), hn::Set(f8, from)));
          const V8 far = hn::Min(hn::Min(x.out(k), y.out(k)), hn::Min(z.out(k), hn::Set(f8, hit.t)));
          hn::Store(near, f8, nears + k);
          hits |= bits_of(f8, hn::Le(near, far)) << k;
        }
        hits &= static_cast<std::uint32_t>(node.inner | node.leaves);
        const int bottom = size;
        while (hits != 0) {
          const auto child = static_cast<std::uint32_t>(std::countr_zero(hits));
          hits &= hits - 1;
          const std::uint32_t below = (1u << child) - 1;
          const bool leaf = node.leaves >> child & 1;
          const std::uint32_t index =
              leaf ? node.first_block + static_cast<std::uint32_t>(std::popcount(node.leaves & below))
                   : node.first_node + static_cast<std::uint32_t>(std::popcount(node.inner & below));
          // All will be asked for soon; those behind the nearest come while it is walked.
          leaf ? prefetch_block(model, index) : prefetch_node(model, index);
          insert(stack, size, bottom, waiting(nears[child], index, leaf));
        }
      }
    }
    if (size == 0) return found;
    entry = stack[--size];
  }
}

template <bool any_hit>
HWY_INLINE bool hit_model(const scene::PlantModel& model, const V3& o, const V3& d, float least, ModelHit& hit) {
  float from = least, to = hit.t;
  if (!cross_hull(model.hull, o, d, from, to)) return false;
  return walk_model<any_hit>(model, o, d, least, waiting(from, 0, false), hit);
}

}  // namespace silvavis::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
