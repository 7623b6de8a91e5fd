// The walk over a pyramid, and the ground's cells.
#if defined(SILVAVIS_NESTED_GROUND) == defined(HWY_TARGET_TOGGLE)
#ifdef SILVAVIS_NESTED_GROUND
#undef SILVAVIS_NESTED_GROUND
#else
#define SILVAVIS_NESTED_GROUND
#endif

#include "silvavis/accel/nested_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace silvavis::accel::HWY_NAMESPACE {

// A node of a pyramid (level >= 0) or an item (level -1) whose box the ray crosses between near and far.
struct PyramidEntry {
  float near, far;
  std::int32_t level, column, row;
};
struct PyramidStack {
  // Levels shrink sixteenfold: sixteen levels hold any grid, and a level leaves at most fifteen behind.
  PyramidEntry entries[16 * 15 + 4];
  int size = 0;

  HWY_INLINE void push(const PyramidEntry& entry) { entries[size++] = entry; }
};

// Bits of children 4 y + x turned so that the ray's own direction only grows: then rising bits are front to back.
HWY_INLINE std::uint32_t turned_bits(std::uint32_t bits, bool flip_x, bool flip_y) {
  if (flip_x) bits = (bits & 0x1111) << 3 | (bits & 0x2222) << 1 | (bits & 0x4444) >> 1 | (bits & 0x8888) >> 3;
  if (flip_y) bits = (bits & 0x000F) << 12 | (bits & 0x00F0) << 4 | (bits & 0x0F00) >> 4 | (bits & 0xF000) >> 12;
  return bits;
}

// Lanes of a node's children: between which distances the ray is above the child's cell, and between which in its box.
struct ChildLanes {
  V8 comes, goes, near, far;
  M8 crossed;
  V8 to_low, high, iz;  // to the box's bottom along the ray; its top above the ray's origin
};

// Calls each(k, lanes) for the children k, k + 1, … of a node, as many as there are lanes.
template <typename Each>
HWY_INLINE void each_child(const scene::Pyramid& pyramid, const FlatRay& ray, const PyramidEntry& entry, float most,
                           const Each& each) {
  const bool flip_x = ray.dx < 0, flip_y = ray.dy < 0;
  const float margin = pyramid.margin_m + 0.01f;  // floats of world space are off by millimetres
  constexpr float slack_m = 0.05f;
  HWY_ALIGN static constexpr float columns[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
  HWY_ALIGN static constexpr float rows[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
  // Heights are counted from the ray's origin.
  const V8 step = hn::Set(f8, pyramid.step_m), iz = hn::Set(f8, ray.iz);
  const V8 below = hn::Set(f8, pyramid.origin_m - ray.oz - slack_m),
           above = hn::Set(f8, pyramid.origin_m - ray.oz + slack_m);
  const scene::Pyramid::Level& level = pyramid.levels[static_cast<std::size_t>(entry.level)];
  const scene::PyramidNode& node =
      level.nodes[static_cast<std::size_t>(entry.row) * static_cast<std::size_t>(level.columns) +
                  static_cast<std::size_t>(entry.column)];
  const auto across = static_cast<float>(1u << (2 * entry.level));
  const float cell_x = pyramid.cell_x_m * across, cell_y = pyramid.cell_y_m * across;
  const float west = pyramid.west + static_cast<float>(entry.column * 4) * cell_x - ray.ox;
  const float south = pyramid.south + static_cast<float>(entry.row * 4) * cell_y - ray.oy;
  // Near and far planes of the first column and row; the others follow cell by cell.
  const float x_in = (west + (flip_x ? cell_x + margin : -margin)) * ray.ix,
              x_out = (west + (flip_x ? -margin : cell_x + margin)) * ray.ix;
  const float y_in = (south + (flip_y ? cell_y + margin : -margin)) * ray.iy,
              y_out = (south + (flip_y ? -margin : cell_y + margin)) * ray.iy;
  const V8 per_x = hn::Set(f8, cell_x * ray.ix), per_y = hn::Set(f8, cell_y * ray.iy);
  const V8 least = hn::Set(f8, entry.near), greatest = hn::Set(f8, std::min(entry.far, most));
  for (std::size_t k = 0; k < 16; k += hn::Lanes(f8)) {
    const V8 to_x = hn::Mul(hn::Load(f8, columns + k), per_x), to_y = hn::Mul(hn::Load(f8, rows + k), per_y);
    const V8 stored_low = floats_of(node.least.data() + k), stored_high = floats_of(node.most.data() + k);
    const V8 low = hn::Add(below, hn::Mul(step, stored_low)), high = hn::Add(above, hn::Mul(step, stored_high));
    const V8 to_low = hn::Mul(low, iz), to_high = hn::Mul(high, iz);
    const V8 comes = hn::Max(hn::Max(hn::Add(hn::Set(f8, x_in), to_x), hn::Add(hn::Set(f8, y_in), to_y)), least);
    const V8 goes = hn::Min(hn::Min(hn::Add(hn::Set(f8, x_out), to_x), hn::Add(hn::Set(f8, y_out), to_y)), greatest);
    const V8 near = hn::Max(comes, hn::Min(to_low, to_high)), far = hn::Min(goes, hn::Max(to_low, to_high));
    const M8 crossed = hn::And(hn::Le(near, far), hn::Le(stored_low, stored_high));
    each(k, ChildLanes{comes, goes, near, far, crossed, to_low, high, iz});
  }
}

// Where the ray crosses the boxes of a node's children.
struct PyramidCrossing {
  HWY_ALIGN float nears[16];
  HWY_ALIGN float fars[16];

  // Bits of the children crossed no farther than `most`.
  HWY_INLINE std::uint32_t cross(const scene::Pyramid& pyramid, const FlatRay& ray, const PyramidEntry& entry,
                                 float most) {
    std::uint32_t hits = 0;
    each_child(pyramid, ray, entry, most, [&](std::size_t k, const ChildLanes& lanes) HWY_ATTR {
      hn::Store(lanes.near, f8, nears + k);
      hn::Store(lanes.far, f8, fars + k);
      hits |= bits_of(f8, lanes.crossed) << k;
    });
    return hits;
  }
};

// From the nearest begin to the farthest end of what the ray crosses; near > far: nothing.
struct Stretch {
  V8 nears, fars;

  HWY_INLINE Stretch() : nears(hn::Set(f8, 1e30f)), fars(hn::Set(f8, -1e30f)) {}
  HWY_INLINE void add(M8 crossed, V8 near, V8 far) {
    nears = hn::Min(nears, hn::IfThenElse(crossed, near, nears));
    fars = hn::Max(fars, hn::IfThenElse(crossed, far, fars));
  }
  HWY_INLINE float near() const { return hn::GetLane(hn::MinOfLanes(f8, nears)); }
  HWY_INLINE float far() const { return hn::GetLane(hn::MaxOfLanes(f8, fars)); }
};

// Calls leaf(entry) for the nodes of level 0 (`leaf_level` 0) or the items (-1) whose box the ray crosses, about front to
// back, from the nodes on the stack down; `best` may shrink meanwhile, and leaf returns true to end the walk.
template <int leaf_level, typename Leaf>
HWY_INLINE void walk_pyramid(const scene::Pyramid& pyramid, const FlatRay& ray, PyramidStack& stack, const double& best,
                             Leaf& leaf) {
  const bool flip_x = ray.dx < 0, flip_y = ray.dy < 0;
  const std::uint32_t flip = (flip_x ? 3u : 0u) | (flip_y ? 12u : 0u);
  PyramidCrossing crossing;
  while (stack.size > 0) {
    PyramidEntry entry = stack.entries[--stack.size];
    const auto most = static_cast<float>(std::min(best, 1e30));
    if (entry.near > most) continue;
    entry.far = std::min(entry.far, most);
    if (entry.level == leaf_level) {
      if (leaf(entry)) return;
      continue;
    }
    const std::uint32_t hits = crossing.cross(pyramid, ray, entry, most);
    for (std::uint32_t order = turned_bits(hits, flip_x, flip_y); order != 0;) {
      const auto last = static_cast<std::uint32_t>(std::bit_width(order)) - 1;
      order ^= 1u << last;
      const std::uint32_t child = last ^ flip;
      stack.push({crossing.nears[child], crossing.fars[child], entry.level - 1,
                  entry.column * 4 + static_cast<std::int32_t>(child & 3),
                  entry.row * 4 + static_cast<std::int32_t>(child >> 2)});
    }
  }
}

// Narrows an entry of level 0 to where the ray crosses the boxes of its items; false: nowhere. How the walk came to the node
// makes no difference.
HWY_INLINE bool narrow(const scene::Pyramid& pyramid, const FlatRay& ray, PyramidEntry& entry) {
  Stretch all;
  each_child(pyramid, ray, entry, entry.far,
             [&](std::size_t, const ChildLanes& lanes) HWY_ATTR { all.add(lanes.crossed, lanes.near, lanes.far); });
  entry.near = all.near();
  entry.far = all.far();
  return entry.near <= entry.far;
}

// The same over land, and between which distances the ray may meet the ground there (near > far: nowhere).
HWY_INLINE bool narrow_land(const scene::LandGrid& land, const FlatRay& ray, PyramidEntry& entry, float& ground_near,
                            float& ground_far) {
  const std::uint8_t* const canopy =
      land.canopy.data() +
      16 * (static_cast<std::size_t>(entry.row) * static_cast<std::size_t>(land.pyramid.levels.front().columns) +
            static_cast<std::size_t>(entry.column));
  Stretch all, ground;
  each_child(land.pyramid, ray, entry, entry.far, [&](std::size_t k, const ChildLanes& lanes) HWY_ATTR {
    all.add(lanes.crossed, lanes.near, lanes.far);
    const V8 top = hn::Sub(lanes.high, hn::Mul(floats_of(canopy + k), hn::Set(f8, scene::LandGrid::canopy_step_m)));
    const V8 to_top = hn::Mul(top, lanes.iz);
    const V8 near = hn::Max(lanes.comes, hn::Min(lanes.to_low, to_top)),
             far = hn::Min(lanes.goes, hn::Max(lanes.to_low, to_top));
    ground.add(hn::And(lanes.crossed, hn::Le(near, far)), near, far);
  });
  entry.near = all.near();
  entry.far = all.far();
  ground_near = ground.near();
  ground_far = ground.far();
  return entry.near <= entry.far;
}

// Down to the nodes of level 0.
template <typename Leaf>
HWY_INLINE void walk_whole_pyramid(const scene::Pyramid& pyramid, const FlatRay& ray, float least, const double& best,
                                   Leaf& leaf) {
  PyramidStack stack;
  stack.push(
      {least, static_cast<float>(std::min(best, 1e30)), static_cast<std::int32_t>(pyramid.levels.size()) - 1, 0, 0});
  walk_pyramid<0>(pyramid, ray, stack, best, leaf);
}

// The two triangles of a cell. The ray's height above each triangle's plane is linear along it; where it turns from above to
// below, the ray enters the ground. A ray that begins a little below, by rounding at the cell's rim, enters there.
struct GroundWalk {
  const scene::Ground& ground;
  const Ray& ray;
  double& best;
  bool found = false;

  HWY_INLINE bool operator()(const PyramidEntry& cell) {
    constexpr double rounding_m = 0.02;
    const int column = cell.column, row = cell.row;
    const double dx = static_cast<double>(ray.direction.x), dy = static_cast<double>(ray.direction.y),
                 dz = static_cast<double>(ray.direction.z);
    // In the cell's own square [0,1] x [0,1].
    const double u0 = (ray.origin.x - ground.west) / ground.cell_x_m - column, du = dx / ground.cell_x_m;
    const double v0 = (ray.origin.y - ground.south) / ground.cell_y_m - row, dv = dy / ground.cell_y_m;
    double from = std::max(static_cast<double>(cell.near), ray.least),
           to = std::min(static_cast<double>(cell.far), best);
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
    if (std::abs(slope) < 1e-15) {
      // Along the cell's side: within it all the way, or nowhere. Planes do not go on beyond it.
      if (at < 0 || at > 1) to = from - 1;
      return;
    }
    const double a = -at / slope, b = (1 - at) / slope;
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
};

// The ground between near and far: begins at the few nodes that the stretch can touch.
HWY_INLINE bool nearest_ground(const scene::Scene& scene, const FlatRay& flat, const Ray& ray, float near, float far,
                               double& best) {
  const scene::Pyramid& pyramid = scene.ground.pyramid;
  const float x0 = flat.ox + flat.dx * near, x1 = flat.ox + flat.dx * far, y0 = flat.oy + flat.dy * near,
              y1 = flat.oy + flat.dy * far;
  constexpr float slack_m = 0.02f;
  int first_level = 0;
  float wide = 4 * pyramid.cell_x_m, high = 4 * pyramid.cell_y_m;
  while ((wide < std::abs(x1 - x0) + 2 * slack_m || high < std::abs(y1 - y0) + 2 * slack_m) &&
         first_level + 1 < static_cast<int>(pyramid.levels.size())) {
    ++first_level;
    wide *= 4;
    high *= 4;
  }
  const scene::Pyramid::Level& level = pyramid.levels[static_cast<std::size_t>(first_level)];
  const auto node_at = [&](float at, float origin, float size, int count) HWY_ATTR {
    return std::clamp(static_cast<int>(std::floor((at - origin) / size)), 0, count - 1);
  };
  const float out_x = flat.dx < 0 ? -slack_m : slack_m, out_y = flat.dy < 0 ? -slack_m : slack_m;
  const int first_column = node_at(x0 - out_x, pyramid.west, wide, level.columns),
            last_column = node_at(x1 + out_x, pyramid.west, wide, level.columns);
  const int first_row = node_at(y0 - out_y, pyramid.south, high, level.rows),
            last_row = node_at(y1 + out_y, pyramid.south, high, level.rows);
  PyramidStack stack;
  const PyramidEntry entry{near, far, first_level, 0, 0};
  const auto push = [&](int column, int row) HWY_ATTR {
    PyramidEntry node = entry;
    node.column = column;
    node.row = row;
    stack.push(node);
  };
  // The farthest first; a stretch no longer than a node touches at most two columns and two rows.
  push(last_column, last_row);
  if (first_column != last_column) push(first_column, last_row);
  if (first_row != last_row) push(last_column, first_row);
  if (first_column != last_column && first_row != last_row) push(first_column, first_row);
  GroundWalk walk{scene.ground, ray, best};
  walk_pyramid<-1>(pyramid, flat, stack, best, walk);
  return walk.found;
}

}  // namespace silvavis::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
