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

// Eight triangles at once (Möller and Trumbore 1997). Keeps the nearest that is no hole; of equally near ones the first.
template <bool any_hit>
HWY_INLINE bool hit_block(const scene::PlantModel& model, std::uint32_t block_index, const V3& o, const V3& d,
                          float least, ModelHit& hit) {
  const scene::TriangleBlock& block = model.blocks[block_index];
  HWY_ALIGN float ts[8], us[8], vs[8], dets[8];
  std::uint32_t hits = 0;
  const V8 step = hn::Set(f8, model.step_m);
  const V8 bx = hn::Set(f8, model.origin.x - o.x), by = hn::Set(f8, model.origin.y - o.y),
           bz = hn::Set(f8, model.origin.z - o.z);
  const V8 dx = hn::Set(f8, d.x), dy = hn::Set(f8, d.y), dz = hn::Set(f8, d.z);
  for (std::size_t k = 0; k < 8; k += hn::Lanes(f8)) {
    const auto corner = [&](int c, int axis, V8 base) HWY_ATTR {
      return hn::Add(
          base,
          hn::Mul(step,
                  floats_of(block.corners[static_cast<std::size_t>(c)][static_cast<std::size_t>(axis)].data() + k)));
    };
    const V8 ax = corner(0, 0, bx), ay = corner(0, 1, by), az = corner(0, 2, bz);
    const V8 e1x = hn::Sub(corner(1, 0, bx), ax), e1y = hn::Sub(corner(1, 1, by), ay),
             e1z = hn::Sub(corner(1, 2, bz), az);
    const V8 e2x = hn::Sub(corner(2, 0, bx), ax), e2y = hn::Sub(corner(2, 1, by), ay),
             e2z = hn::Sub(corner(2, 2, bz), az);
    const V8 px = hn::Sub(hn::Mul(dy, e2z), hn::Mul(dz, e2y));
    const V8 py = hn::Sub(hn::Mul(dz, e2x), hn::Mul(dx, e2z));
    const V8 pz = hn::Sub(hn::Mul(dx, e2y), hn::Mul(dy, e2x));
    const V8 det = hn::Add(hn::Add(hn::Mul(e1x, px), hn::Mul(e1y, py)), hn::Mul(e1z, pz));
    // The ray begins at the origin: the corner's way to it is -a.
    const V8 inverse_det = hn::Div(hn::Set(f8, 1.0f), det);
    const V8 u = hn::Neg(hn::Mul(hn::Add(hn::Add(hn::Mul(ax, px), hn::Mul(ay, py)), hn::Mul(az, pz)), inverse_det));
    const V8 qx = hn::Sub(hn::Mul(az, e1y), hn::Mul(ay, e1z));
    const V8 qy = hn::Sub(hn::Mul(ax, e1z), hn::Mul(az, e1x));
    const V8 qz = hn::Sub(hn::Mul(ay, e1x), hn::Mul(ax, e1y));
    const V8 v = hn::Mul(hn::Add(hn::Add(hn::Mul(dx, qx), hn::Mul(dy, qy)), hn::Mul(dz, qz)), inverse_det);
    const V8 t = hn::Mul(hn::Add(hn::Add(hn::Mul(e2x, qx), hn::Mul(e2y, qy)), hn::Mul(e2z, qz)), inverse_det);
    const V8 zero = hn::Zero(f8);
    auto inside = hn::And(hn::Ge(u, zero), hn::Ge(v, zero));
    inside = hn::And(inside, hn::Le(hn::Add(u, v), hn::Set(f8, 1.0f)));
    inside = hn::And(inside, hn::And(hn::Ge(t, hn::Set(f8, least)), hn::Lt(t, hn::Set(f8, hit.t))));
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
    if (ts[lane] >= hit.t) continue;
    const std::uint32_t slot = block_index * scene::block_size + lane;
    if (dets[lane] < 0 && !model.looks->cutouts[block.materials[lane]].two_sided) continue;
    if (scene::is_hole(model, slot, us[lane], vs[lane])) continue;
    hit = {ts[lane], us[lane], vs[lane], slot};
    found = true;
    if (any_hit) return true;
  }
  return found;
}

template <bool any_hit>
HWY_INLINE bool hit_model(const scene::PlantModel& model, const V3& o, const V3& d, float least, ModelHit& hit) {
  float from = least, to = hit.t;
  if (!cross_hull(model.hull, o, d, from, to)) return false;

  // Each level leaves at most fifteen behind.
  std::uint64_t stack[scene::most_depth * (scene::node_size - 1) + 1];
  int size = 0;
  stack[size++] = waiting(0, 0, false);
  bool found = false;
  const float ix = inverse(d.x), iy = inverse(d.y), iz = inverse(d.z);
  while (size > 0) {
    const std::uint64_t entry = stack[--size];
    if (from + distance_of(entry) > hit.t) continue;
    if (is_leaf(entry)) {
      if (hit_block<any_hit>(model, index_of(entry), o, d, least, hit)) {
        found = true;
        if (any_hit) return true;
      }
      continue;
    }
    const scene::TreeNode& node = model.nodes[index_of(entry)];
    const auto& x_in = d.x < 0 ? node.most[0] : node.least[0];
    const auto& x_out = d.x < 0 ? node.least[0] : node.most[0];
    const auto& y_in = d.y < 0 ? node.most[1] : node.least[1];
    const auto& y_out = d.y < 0 ? node.least[1] : node.most[1];
    const auto& z_in = d.z < 0 ? node.most[2] : node.least[2];
    const auto& z_out = d.z < 0 ? node.least[2] : node.most[2];
    // Distance to a bound = byte * scale + shift.
    const V8 scale_x = hn::Set(f8, node.step(0) * ix), shift_x = hn::Set(f8, (node.origin[0] - o.x) * ix);
    const V8 scale_y = hn::Set(f8, node.step(1) * iy), shift_y = hn::Set(f8, (node.origin[1] - o.y) * iy);
    const V8 scale_z = hn::Set(f8, node.step(2) * iz), shift_z = hn::Set(f8, (node.origin[2] - o.z) * iz);
    HWY_ALIGN float nears[16];
    std::uint32_t hits = 0;
    for (std::size_t k = 0; k < 16; k += hn::Lanes(f8)) {
      const auto distance = [&](const auto& bytes, V8 scale, V8 shift)
                                HWY_ATTR { return hn::Add(hn::Mul(floats_of(bytes.data() + k), scale), shift); };
      const V8 near = hn::Max(hn::Max(distance(x_in, scale_x, shift_x), distance(y_in, scale_y, shift_y)),
                              hn::Max(distance(z_in, scale_z, shift_z), hn::Set(f8, from)));
      const V8 far = hn::Min(hn::Min(distance(x_out, scale_x, shift_x), distance(y_out, scale_y, shift_y)),
                             hn::Min(distance(z_out, scale_z, shift_z), hn::Set(f8, std::min(hit.t, to))));
      // Rounding may shorten a grazed box by a few units in the last place (Ize 2013).
      const V8 wider = hn::Add(far, hn::Set(f8, 1e-5f));
      hn::Store(hn::Sub(near, hn::Set(f8, from)), f8, nears + k);
      hits |= bits_of(f8, hn::Le(near, wider)) << k;
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
      if (leaf) {
        const auto* block = reinterpret_cast<const std::uint8_t*>(&model.blocks[index]);
        for (int line = 0; line < 4; ++line) hwy::Prefetch(block + line * 64);
      } else {
        const auto* next = reinterpret_cast<const std::uint8_t*>(&model.nodes[index]);
        hwy::Prefetch(next);
        hwy::Prefetch(next + 64);
      }
      insert(stack, size, bottom, waiting(nears[child], index, leaf));
    }
  }
  return found;
}

}  // namespace silvavis::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
