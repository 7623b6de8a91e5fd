// Rays that go about the same way walk a pyramid together: one crossing of a node's children serves them all.
//
// Neighbouring pixels look at the same land, and the sun's rays from there are parallel. A bundle crosses boxes by intervals that
// hold all its rays; where it comes to a node of level 0, each ray asks for itself, so what a ray meets does not depend on
// whom it walked with.
// Source: interval arithmetic over packets, Boulos, Wald and Shirley 2006.
#if defined(SILVAVIS_NESTED_BUNDLE) == defined(HWY_TARGET_TOGGLE)
#ifdef SILVAVIS_NESTED_BUNDLE
#undef SILVAVIS_NESTED_BUNDLE
#else
#define SILVAVIS_NESTED_BUNDLE
#endif

#include "silvavis/accel/nested_ground.h"

HWY_BEFORE_NAMESPACE();
namespace silvavis::accel::HWY_NAMESPACE {

struct Bundle {
  static constexpr std::size_t most_rays = 16;

  std::size_t count = 0;
  FlatRay flats[most_rays];
  double bests[most_rays];  // what is farther does not count; less than any distance where a ray needs no more
  float leasts[most_rays];
  // By ray, for slabs of one box.
  HWY_ALIGN float ox[most_rays], oy[most_rays], oz[most_rays], ix[most_rays], iy[most_rays], iz[most_rays];
  // Over all rays; the inverses without their sign.
  float least_ox, most_ox, least_oy, most_oy, least_oz, most_oz, least_dz, most_dz;
  float least_ix, most_ix, least_iy, most_iy;
  float least;
  // How far the rays are from the first one at a distance t: apart + t * part.
  float apart, part;

  bool flip_x() const { return flats[0].dx < 0; }
  bool flip_y() const { return flats[0].dy < 0; }
  // The farthest that any ray still asks for.
  HWY_INLINE float most() const {
    double most = bests[0];
    for (std::size_t i = 1; i < count; ++i) most = std::max(most, bests[i]);
    return static_cast<float>(std::min(most, 1e30));
  }
};

// Whether two rays walk together: over the ground in the same quarter of the compass and within some degrees, and from
// origins no farther apart than `apart_m`.
HWY_INLINE bool alike(const Ray& a, const Ray& b, double apart_m) {
  return (a.direction.x < 0) == (b.direction.x < 0) && (a.direction.y < 0) == (b.direction.y < 0) &&
         a.direction.x * b.direction.x + a.direction.y * b.direction.y + a.direction.z * b.direction.z > 0.995f &&
         std::abs(a.origin.x - b.origin.x) < apart_m && std::abs(a.origin.y - b.origin.y) < apart_m;
}

// The first of `rays` that are alike; alone the first where too few are.
HWY_INLINE void gather(std::span<const Ray> rays, double apart_m, Bundle& bundle) {
  std::size_t n = 1;
  while (n < rays.size() && n < Bundle::most_rays && alike(rays[0], rays[n], apart_m)) ++n;
  constexpr std::size_t few = 4;
  bundle.count = n < few ? 1 : n;
  if (n < few) return;
  for (std::size_t i = 0; i < Bundle::most_rays; ++i) {
    // The last ray again where there are no more: their answers are not looked at.
    const std::size_t from = std::min(i, n - 1);
    const FlatRay flat(rays[from]);
    bundle.flats[i] = flat;
    bundle.bests[i] = rays[from].most;
    bundle.leasts[i] = static_cast<float>(rays[from].least);
    bundle.ox[i] = flat.ox;
    bundle.oy[i] = flat.oy;
    bundle.oz[i] = flat.oz;
    bundle.ix[i] = flat.ix;
    bundle.iy[i] = flat.iy;
    bundle.iz[i] = flat.iz;
  }
  const auto range = [](const float* values, float& least, float& most) HWY_ATTR {
    V8 low = hn::Load(f8, values), high = low;
    for (std::size_t k = hn::Lanes(f8); k < Bundle::most_rays; k += hn::Lanes(f8)) {
      low = hn::Min(low, hn::Load(f8, values + k));
      high = hn::Max(high, hn::Load(f8, values + k));
    }
    least = hn::GetLane(hn::MinOfLanes(f8, low));
    most = hn::GetLane(hn::MaxOfLanes(f8, high));
  };
  range(bundle.ox, bundle.least_ox, bundle.most_ox);
  range(bundle.oy, bundle.least_oy, bundle.most_oy);
  range(bundle.oz, bundle.least_oz, bundle.most_oz);
  range(bundle.ix, bundle.least_ix, bundle.most_ix);
  range(bundle.iy, bundle.least_iy, bundle.most_iy);
  const auto without_sign = [](float& least, float& most) HWY_ATTR {
    if (most > 0) return;
    std::swap(least, most);
    least = -least;
    most = -most;
  };
  without_sign(bundle.least_ix, bundle.most_ix);
  without_sign(bundle.least_iy, bundle.most_iy);
  bundle.least_dz = bundle.most_dz = bundle.flats[0].dz;
  bundle.least = bundle.leasts[0];
  bundle.apart = bundle.part = 0;
  for (std::size_t i = 1; i < n; ++i) {
    const V3d apart = rays[i].origin - rays[0].origin;
    bundle.apart =
        std::max(bundle.apart, static_cast<float>(std::abs(apart.x) + std::abs(apart.y) + std::abs(apart.z)));
    const V3 part = rays[i].direction - rays[0].direction;
    bundle.part = std::max(bundle.part, std::abs(part.x) + std::abs(part.y) + std::abs(part.z));
    bundle.least_dz = std::min(bundle.least_dz, bundle.flats[i].dz);
    bundle.most_dz = std::max(bundle.most_dz, bundle.flats[i].dz);
    bundle.least = std::min(bundle.least, bundle.leasts[i]);
  }
}

// A node that some ray of a bundle may cross between near and far, and the heights of what it holds.
struct BundleEntry {
  float near, far, low, high;
  std::int32_t level, column, row;
};

// Calls leaf(rays, near, column, row) for the nodes of level 0 whose box some rays cross, with those rays' bits and where the
// first of them enters it, about front to back. `leaf` may shrink the rays' bests.
template <typename Leaf>
HWY_INLINE void walk_pyramid_together(const scene::Pyramid& pyramid, Bundle& bundle, Leaf& leaf) {
  const bool flip_x = bundle.flip_x(), flip_y = bundle.flip_y();
  const std::uint32_t flip = (flip_x ? 3u : 0u) | (flip_y ? 12u : 0u);
  const float margin = pyramid.margin_m + 0.02f;
  constexpr float slack_m = 0.05f;
  HWY_ALIGN static constexpr float columns[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
  HWY_ALIGN static constexpr float rows[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
  BundleEntry stack[16 * 15 + 4];
  int size = 0;
  float most = bundle.most();
  stack[size++] = {bundle.least,
                   most,
                   pyramid.origin_m,
                   pyramid.origin_m + 65535 * pyramid.step_m,
                   static_cast<std::int32_t>(pyramid.levels.size()) - 1,
                   0,
                   0};
  while (size > 0) {
    const BundleEntry entry = stack[--size];
    if (entry.near > most) continue;
    const auto across = static_cast<float>(1u << (2 * entry.level));
    const float cell_x = pyramid.cell_x_m * across, cell_y = pyramid.cell_y_m * across;
    const float west = pyramid.west + static_cast<float>(entry.column * 4) * cell_x;
    const float south = pyramid.south + static_cast<float>(entry.row * 4) * cell_y;
    if (entry.level == 0) {
      // Each ray for itself against the node's box.
      const V8 x_in = hn::Set(f8, flip_x ? west + 4 * cell_x + margin : west - margin),
               x_out = hn::Set(f8, flip_x ? west - margin : west + 4 * cell_x + margin);
      const V8 y_in = hn::Set(f8, flip_y ? south + 4 * cell_y + margin : south - margin),
               y_out = hn::Set(f8, flip_y ? south - margin : south + 4 * cell_y + margin);
      const V8 low = hn::Set(f8, entry.low - slack_m), high = hn::Set(f8, entry.high + slack_m);
      HWY_ALIGN float nears[Bundle::most_rays];
      std::uint32_t hits = 0;
      for (std::size_t k = 0; k < Bundle::most_rays; k += hn::Lanes(f8)) {
        const V8 ox = hn::Load(f8, bundle.ox + k), ix = hn::Load(f8, bundle.ix + k), oy = hn::Load(f8, bundle.oy + k),
                 iy = hn::Load(f8, bundle.iy + k), oz = hn::Load(f8, bundle.oz + k), iz = hn::Load(f8, bundle.iz + k);
        const V8 to_low = hn::Mul(hn::Sub(low, oz), iz), to_high = hn::Mul(hn::Sub(high, oz), iz);
        const V8 near = hn::Max(hn::Max(hn::Mul(hn::Sub(x_in, ox), ix), hn::Mul(hn::Sub(y_in, oy), iy)),
                                hn::Max(hn::Min(to_low, to_high), hn::LoadU(f8, bundle.leasts + k)));
        const V8 far = hn::Min(hn::Min(hn::Mul(hn::Sub(x_out, ox), ix), hn::Mul(hn::Sub(y_out, oy), iy)),
                               hn::Max(to_low, to_high));
        hn::Store(near, f8, nears + k);
        hits |= bits_of(f8, hn::Le(near, far)) << k;
      }
      std::uint32_t rays = 0;
      float first = 1e30f;
      for (hits &= (1u << bundle.count) - 1; hits != 0; hits &= hits - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(hits));
        if (nears[i] > static_cast<float>(std::min(bundle.bests[i], 1e30))) continue;
        rays |= 1u << i;
        first = std::min(first, nears[i]);
      }
      if (rays == 0) continue;
      leaf(rays, first, entry.column, entry.row);
      most = bundle.most();
      continue;
    }
    const scene::Pyramid::Level& level = pyramid.levels[static_cast<std::size_t>(entry.level)];
    const scene::PyramidNode& node =
        level.nodes[static_cast<std::size_t>(entry.row) * static_cast<std::size_t>(level.columns) +
                    static_cast<std::size_t>(entry.column)];
    // How far the nearest and the farthest ray have to go to a child's planes, along the rays' own way over the ground; the
    // children follow cell by cell.
    const float x_to = flip_x ? bundle.least_ox - (west + cell_x + margin) : west - margin - bundle.most_ox,
                x_past = flip_x ? bundle.most_ox - (west - margin) : west + cell_x + margin - bundle.least_ox;
    const float y_to = flip_y ? bundle.least_oy - (south + cell_y + margin) : south - margin - bundle.most_oy,
                y_past = flip_y ? bundle.most_oy - (south - margin) : south + cell_y + margin - bundle.least_oy;
    const V8 per_x = hn::Set(f8, flip_x ? -cell_x : cell_x), per_y = hn::Set(f8, flip_y ? -cell_y : cell_y);
    const V8 least_ix = hn::Set(f8, bundle.least_ix), most_ix = hn::Set(f8, bundle.most_ix),
             least_iy = hn::Set(f8, bundle.least_iy), most_iy = hn::Set(f8, bundle.most_iy);
    const V8 least_dz = hn::Set(f8, bundle.least_dz), most_dz = hn::Set(f8, bundle.most_dz);
    const V8 step = hn::Set(f8, pyramid.step_m), origin = hn::Set(f8, pyramid.origin_m);
    HWY_ALIGN float nears[16];
    HWY_ALIGN float fars[16];
    HWY_ALIGN float lows[16];
    HWY_ALIGN float highs[16];
    std::uint32_t hits = 0;
    for (std::size_t k = 0; k < 16; k += hn::Lanes(f8)) {
      const V8 by_x = hn::Mul(hn::Load(f8, columns + k), per_x), by_y = hn::Mul(hn::Load(f8, rows + k), per_y);
      const V8 to_x = hn::Add(hn::Set(f8, x_to), by_x), to_y = hn::Add(hn::Set(f8, y_to), by_y),
               past_x = hn::Add(hn::Set(f8, x_past), by_x), past_y = hn::Add(hn::Set(f8, y_past), by_y);
      const V8 near = hn::Max(hn::Max(hn::Min(hn::Mul(to_x, least_ix), hn::Mul(to_x, most_ix)),
                                      hn::Min(hn::Mul(to_y, least_iy), hn::Mul(to_y, most_iy))),
                              hn::Set(f8, entry.near));
      const V8 far = hn::Min(hn::Min(hn::Max(hn::Mul(past_x, least_ix), hn::Mul(past_x, most_ix)),
                                     hn::Max(hn::Mul(past_y, least_iy), hn::Mul(past_y, most_iy))),
                             hn::Set(f8, std::min(entry.far, most)));
      const V8 stored_low = floats_of(node.least.data() + k), stored_high = floats_of(node.most.data() + k);
      const V8 low = hn::Add(origin, hn::Mul(step, stored_low)), high = hn::Add(origin, hn::Mul(step, stored_high));
      const V8 lowest = hn::Add(hn::Set(f8, bundle.least_oz - slack_m),
                                hn::Min(hn::Mul(least_dz, near), hn::Mul(least_dz, far))),
               highest = hn::Add(hn::Set(f8, bundle.most_oz + slack_m),
                                 hn::Max(hn::Mul(most_dz, near), hn::Mul(most_dz, far)));
      auto crossed = hn::And(hn::Le(near, far), hn::Le(stored_low, stored_high));
      crossed = hn::And(crossed, hn::And(hn::Le(lowest, high), hn::Ge(highest, low)));
      hn::Store(near, f8, nears + k);
      hn::Store(far, f8, fars + k);
      hn::Store(low, f8, lows + k);
      hn::Store(high, f8, highs + k);
      hits |= bits_of(f8, crossed) << k;
    }
    for (std::uint32_t order = turned_bits(hits, flip_x, flip_y); order != 0;) {
      const auto last = static_cast<std::uint32_t>(std::bit_width(order)) - 1;
      order ^= 1u << last;
      const std::uint32_t child = last ^ flip;
      stack[size++] = {nears[child],
                       fars[child],
                       lows[child],
                       highs[child],
                       entry.level - 1,
                       entry.column * 4 + static_cast<std::int32_t>(child & 3),
                       entry.row * 4 + static_cast<std::int32_t>(child >> 2)};
    }
  }
}

}  // namespace silvavis::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
