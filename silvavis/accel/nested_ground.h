// The walk over a pyramid, and the ground's cells at its end.
#if defined(SILVAVIS_NESTED_GROUND) == defined(HWY_TARGET_TOGGLE)
#ifdef SILVAVIS_NESTED_GROUND
#undef SILVAVIS_NESTED_GROUND
#else
#define SILVAVIS_NESTED_GROUND
#endif

#include "silvavis/accel/nested_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace silvavis::accel::HWY_NAMESPACE {

// Calls leaf(column, row, near, far, low, high) for the items whose box the ray crosses between `least` and `best`, about front to
// back; `best` may shrink meanwhile, and leaf returns true to end the walk.
template <typename Leaf>
HWY_INLINE void walk_pyramid(const scene::Pyramid& pyramid, const FlatRay& ray, float least, const double& best,
                             Leaf& leaf) {
  struct Entry {
    float near, far, low, high;
    std::int32_t level, column, row;
  };
  // Levels shrink sixteenfold: sixteen levels hold any grid, and a level leaves at most fifteen behind.
  Entry stack[16 * 15 + 1];
  int size = 0;
  const int top = static_cast<int>(pyramid.levels.size()) - 1;
  stack[size++] = {least, static_cast<float>(std::min(best, 1e30)), 0, 0, top, 0, 0};
  const bool flip_x = ray.dx < 0, flip_y = ray.dy < 0;
  const std::uint32_t flip = (flip_x ? 3u : 0u) | (flip_y ? 12u : 0u);
  const float margin = pyramid.margin_m + 1e-3f;
  // Floats of world space are off by up to the ray's length / 2^23.
  constexpr float slack_m = 0.05f;

  while (size > 0) {
    const Entry entry = stack[--size];
    const auto most = static_cast<float>(std::min(best, 1e30));
    if (entry.near > most) continue;
    if (entry.level < 0) {
      if (leaf(entry.column, entry.row, entry.near, std::min(entry.far, most), entry.low, entry.high)) return;
      continue;
    }
    const scene::Pyramid::Level& level = pyramid.levels[static_cast<std::size_t>(entry.level)];
    const scene::PyramidNode& node =
        level.nodes[static_cast<std::size_t>(entry.row) * static_cast<std::size_t>(level.columns) +
                    static_cast<std::size_t>(entry.column)];
    const auto across = static_cast<float>(1u << (2 * entry.level));
    const float cell_x = pyramid.cell_x_m * across, cell_y = pyramid.cell_y_m * across;
    const float west = pyramid.west + static_cast<float>(entry.column * 4) * cell_x - ray.ox;
    const float south = pyramid.south + static_cast<float>(entry.row * 4) * cell_y - ray.oy;

    HWY_ALIGN float x_near[4], x_far[4];
    float y_near[4], y_far[4];
    for (int k = 0; k < 4; ++k) {
      const float x0 = (west + static_cast<float>(k) * cell_x - margin) * ray.ix;
      const float x1 = (west + static_cast<float>(k + 1) * cell_x + margin) * ray.ix;
      const float y0 = (south + static_cast<float>(k) * cell_y - margin) * ray.iy;
      const float y1 = (south + static_cast<float>(k + 1) * cell_y + margin) * ray.iy;
      x_near[k] = std::min(x0, x1);
      x_far[k] = std::max(x0, x1);
      y_near[k] = std::min(y0, y1);
      y_far[k] = std::max(y0, y1);
    }
    HWY_ALIGN float nears[16], fars[16], lows[16], highs[16];
    std::uint32_t hits = 0;
    for (std::size_t row = 0; row < 4; ++row) {
      for (std::size_t x = 0; x < 4; x += hn::Lanes(f4)) {
        const std::size_t child = row * 4 + x;
        const auto near = hn::Max(hn::Max(hn::Load(f4, x_near + x), hn::Set(f4, y_near[row])), hn::Set(f4, entry.near));
        const auto far =
            hn::Min(hn::Min(hn::Load(f4, x_far + x), hn::Set(f4, y_far[row])), hn::Set(f4, std::min(entry.far, most)));
        const auto step = hn::Set(f4, pyramid.step_m), base = hn::Set(f4, pyramid.origin_m);
        const auto low = hn::Add(base, hn::Mul(step, four_floats_of(node.least.data() + child)));
        const auto high = hn::Add(base, hn::Mul(step, four_floats_of(node.most.data() + child)));
        const auto dz = hn::Set(f4, ray.dz), oz = hn::Set(f4, ray.oz);
        const auto z_in = hn::Add(oz, hn::Mul(dz, near)), z_out = hn::Add(oz, hn::Mul(dz, far));
        auto crossed = hn::Le(near, far);
        crossed = hn::And(crossed, hn::Le(low, high));
        crossed = hn::And(crossed, hn::Le(hn::Min(z_in, z_out), hn::Add(high, hn::Set(f4, slack_m))));
        crossed = hn::And(crossed, hn::Ge(hn::Max(z_in, z_out), hn::Sub(low, hn::Set(f4, slack_m))));
        hn::Store(near, f4, nears + child);
        hn::Store(far, f4, fars + child);
        hn::Store(low, f4, lows + child);
        hn::Store(high, f4, highs + child);
        hits |= bits_of(f4, crossed) << child;
      }
    }
    // Push from the far corner to the near one: in the ray's own direction columns and rows only grow.
    for (std::uint32_t k = 16; k-- > 0;) {
      const std::uint32_t child = k ^ flip;
      if ((hits >> child & 1) == 0) continue;
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

// The two triangles of a cell. The ray's height above each triangle's plane is linear along it; where it turns from above to
// below, the ray enters the ground. A ray that begins a little below, by rounding at the cell's rim, enters there.
struct GroundWalk {
  const scene::Ground& ground;
  const Ray& ray;
  double& best;
  bool found = false;

  HWY_INLINE bool operator()(int column, int row, float near, float far, float, float) {
    constexpr double rounding_m = 0.02;
    const double dx = static_cast<double>(ray.direction.x), dy = static_cast<double>(ray.direction.y),
                 dz = static_cast<double>(ray.direction.z);
    // In the cell's own square [0,1] x [0,1].
    const double u0 = (ray.origin.x - ground.west) / ground.cell_x_m - column, du = dx / ground.cell_x_m;
    const double v0 = (ray.origin.y - ground.south) / ground.cell_y_m - row, dv = dy / ground.cell_y_m;
    double from = std::max(static_cast<double>(near), ray.least), to = std::min(static_cast<double>(far), best);
    clip(u0, du, from, to);
    clip(v0, dv, from, to);
    if (from > to) return false;
    const auto height = [&](int i, int j) HWY_ATTR { return static_cast<double>(ground.at(column + i, row + j)); };
    const double south_west = height(0, 0), south_east = height(1, 0), north_west = height(0, 1),
                 north_east = height(1, 1);
    // Above the plane of the south-eastern (u > v) or north-western triangle at a distance t.
    const auto above = [&](bool south_eastern, double t) HWY_ATTR {
      const double along_u = south_eastern ? south_east - south_west : north_east - north_west;
      const double along_v = south_eastern ? north_east - south_east : north_west - south_west;
      return ray.origin.z + t * dz - (south_west + along_u * (u0 + t * du) + along_v * (v0 + t * dv));
    };
    const auto part = [&](bool south_eastern, double begin, double end) HWY_ATTR {
      const double over = above(south_eastern, begin), under = above(south_eastern, end);
      if (under > 0 || over < -rounding_m) return false;
      if (over <= 0 && under >= over) return false;  // below, and rising
      const double t = over <= 0 ? begin : begin + (end - begin) * over / (over - under);
      if (t < ray.least || t > best) return false;
      best = t;
      found = true;
      return true;
    };
    // Where the ray crosses the cell's diagonal it changes the triangle.
    const double begins = u0 + from * du - (v0 + from * dv), ends = u0 + to * du - (v0 + to * dv);
    if ((begins > 0) == (ends > 0)) return part(begins > 0, from, to);
    const double middle = from + (to - from) * begins / (begins - ends);
    return part(begins > 0, from, middle) || part(ends > 0, middle, to);
  }

 private:
  static HWY_INLINE void clip(double at, double slope, double& from, double& to) {
    if (std::abs(slope) < 1e-15) return;
    const double a = -at / slope, b = (1 - at) / slope;
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
};

HWY_INLINE bool nearest_ground(const scene::Ground& ground, const FlatRay& flat, const Ray& ray, double& best) {
  GroundWalk walk{ground, ray, best};
  walk_pyramid(ground.pyramid, flat, static_cast<float>(ray.least), best, walk);
  return walk.found;
}

}  // namespace silvavis::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
