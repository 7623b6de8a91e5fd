// Cutting a field down to a box: primitives that are 0 there vanish, those that are 1 throughout become constants, and operators
// fold. Ranges of operators need no slack: sums, products, least and greatest of floats never fall where what they are
// made of rises.
#include <algorithm>
#include <cmath>

#include "ghosttile/density/tree.h"

namespace ghosttile::density {

namespace {

struct Query {
  Box3 box;
  V3d middle{0, 0, 0};
  double half_diagonal_m = 0;
  bool finite = true;

  explicit Query(const Box3& of) : box(of), middle((of.least + of.most) * 0.5) {
    const V3d d = of.most - of.least;
    half_diagonal_m = 0.5 * std::sqrt(d.dot(d));
    finite = std::isfinite(half_diagonal_m);
  }
};

double above_zero(double x) { return x > 0 ? x : 0; }

// From the surface of a solid or from a skeleton: below 0 inside. Changes no faster than the place moves.
double signed_distance(const Leaf& leaf, const V3d& place) {
  const V3d q = place - leaf.at;
  switch (leaf.kind) {
    case Kind::segment:
    case Kind::cylinder: {
      const double u = q.dot(leaf.axis);
      const V3d off = q - leaf.axis * u;
      const double across = std::sqrt(off.dot(off)) - leaf.size_m, along = std::max(-u, u - leaf.length_m);
      if (leaf.kind == Kind::segment) return std::sqrt(off.dot(off) + above_zero(along) * above_zero(along));
      if (across <= 0 && along <= 0) return std::max(across, along);
      return std::sqrt(above_zero(across) * above_zero(across) + above_zero(along) * above_zero(along));
    }
    case Kind::disc: {
      const double h = q.dot(leaf.axis);
      const V3d off = q - leaf.axis * h;
      const double across = above_zero(std::sqrt(off.dot(off)) - leaf.size_m);
      return std::sqrt(h * h + across * across);
    }
    case Kind::box: {
      const double x = std::abs(q.x * leaf.cos_turn + q.y * leaf.sin_turn) - leaf.half.x;
      const double y = std::abs(q.y * leaf.cos_turn - q.x * leaf.sin_turn) - leaf.half.y;
      const double z = std::abs(q.z) - leaf.half.z;
      if (x <= 0 && y <= 0 && z <= 0) return std::max({x, y, z});
      return std::sqrt(above_zero(x) * above_zero(x) + above_zero(y) * above_zero(y) + above_zero(z) * above_zero(z));
    }
    default:
      return std::sqrt(q.dot(q)) - leaf.size_m;
  }
}

// The value at a distance, in doubles.
double falloff(const Leaf& leaf, double distance_m) {
  const double t = std::clamp((distance_m / leaf.radius_m - leaf.core) / (1 - leaf.core), 0.0, 1.0);
  const double v = 1 - t * t;
  return v * v * v;
}

Range range_between(const Leaf& leaf, double nearest_m, double farthest_m) {
  if (nearest_m > leaf.radius_m) return {0, 0};
  if (farthest_m <= leaf.radius_m * (leaf.sharp() ? 1 : leaf.core)) return {1, 1};
  if (leaf.sharp()) return {0, 1};
  const double most = falloff(leaf, above_zero(nearest_m)), least = falloff(leaf, above_zero(farthest_m));
  return {static_cast<float>(least * (1 - 1e-6)), static_cast<float>(std::min(1.0, most * (1 + 1e-6)))};
}

bool apart(const Box3& a, const Box3& b, double by) {
  return a.least.x > b.most.x + by || b.least.x > a.most.x + by || a.least.y > b.most.y + by ||
         b.least.y > a.most.y + by || a.least.z > b.most.z + by || b.least.z > a.most.z + by;
}

class Cutter {
 public:
  Cutter(const Tree& tree, const std::vector<Item>& items, std::vector<Item>& out)
      : tree_(tree), items_(items), out_(out) {}

  Range cut(std::size_t at, const Query& query) {
    const Item& item = items_[at];
    if (item.kind == Kind::constant) {
      out_.push_back(item);
      return {item.value, item.value};
    }
    const std::size_t begin = out_.size();
    out_.push_back(item);
    Range range;
    if (!is_operator(item.kind)) {
      range = range_of(tree_.leaves[item.index], query);
    } else if (item.kind == Kind::scale) {
      range = cut(at + 1, query);
      range = {range.least * item.value, range.most * item.value};
      if (item.value == 1) return erased(begin, range);
    } else if (item.kind == Kind::warp) {
      const double far_m = tree_.warps[item.index].far_m * (1 + slack);
      range = cut(at + 1, Query({query.box.least - V3d(far_m), query.box.most + V3d(far_m)}));
      if (far_m == 0) return erased(begin, range);
    } else {
      std::size_t kept = 0;
      range = combined(at, query, begin, kept);
      if (kept == 1 && range.least < range.most && !(item.kind == Kind::blend && unclamped_))
        return erased(begin, range);
    }
    // What takes one value only is a constant.
    if (!(range.least < range.most)) {
      out_.resize(begin);
      out_.push_back({Kind::constant, 0, 1, range.least});
      return range;
    }
    out_[begin].span = static_cast<std::uint32_t>(out_.size() - begin);
    return range;
  }

 private:
  Range erased(std::size_t begin, Range range) {
    out_.erase(out_.begin() + static_cast<std::ptrdiff_t>(begin));
    return range;
  }

  Range range_of(const Leaf& leaf, const Query& query) const {
    if (leaf.kind == Kind::layer || leaf.kind == Kind::above || leaf.kind == Kind::column)
      return range_of_plane(leaf, query);
    const double doubt_m = slack * ((query.finite ? 2 * query.half_diagonal_m : 0) + leaf.reach_m);
    if (apart(leaf.bounds, query.box, doubt_m)) return {0, 0};
    if (!query.finite) return {0, 1};
    const double middle_m = signed_distance(leaf, query.middle);
    return range_between(leaf, middle_m - query.half_diagonal_m - doubt_m, middle_m + query.half_diagonal_m + doubt_m);
  }

  Range range_of_plane(const Leaf& leaf, const Query& query) const {
    const double doubt_m = slack * ((query.finite ? 2 * query.half_diagonal_m : 0) + leaf.reach_m);
    const Box3& box = query.box;
    if (leaf.kind != Kind::column && apart(leaf.bounds, box, doubt_m)) return {0, 0};
    const Range plane = tree_.planes[leaf.plane]->bounds(box.least.x - doubt_m, box.least.y - doubt_m,
                                                         box.most.x + doubt_m, box.most.y + doubt_m);
    if (leaf.kind == Kind::column) return {std::max(plane.least, 0.0f), std::max(plane.most, 0.0f)};
    const double low_m = box.least.z - static_cast<double>(plane.most) - doubt_m;
    const double high_m = box.most.z - static_cast<double>(plane.least) + doubt_m;
    if (leaf.kind == Kind::above) return {low_m >= leaf.from_m ? 1.0f : 0.0f, high_m < leaf.from_m ? 0.0f : 1.0f};
    const double middle_m = 0.5 * (leaf.from_m + leaf.to_m), half_m = 0.5 * (leaf.to_m - leaf.from_m);
    const double nearest_m = std::max({low_m - middle_m, middle_m - high_m, 0.0}) - half_m;
    const double farthest_m = std::max(std::abs(low_m - middle_m), std::abs(high_m - middle_m)) - half_m;
    return range_between(leaf, nearest_m, farthest_m);
  }

  // An operator with any number of children: appends those that matter and counts them.
  Range combined(std::size_t at, const Query& query, std::size_t begin, std::size_t& kept) {
    const Kind kind = items_[at].kind;
    Range all{0, 0};
    bool any = false;
    for (std::size_t child = at + 1; child < at + items_[at].span; child += items_[child].span) {
      const std::size_t start = out_.size();
      const Range one = cut(child, query);
      bool drop = false, alone = false;
      if (kind == Kind::blend) {
        drop = !(one.most > 0);
        all = {all.least + one.least, all.most + one.most};
        if (all.least >= 1) return {1, 1};
      } else if (kind == Kind::multiply) {
        if (!(one.most > 0)) return {0, 0};
        drop = one.least == 1 && one.most == 1;
        all = any ? Range{all.least * one.least, all.most * one.most} : one;
      } else if (!any) {
        all = one;
        if (kind != Kind::unite && !(one.most > 0)) return {0, 0};
      } else if (kind == Kind::unite) {
        drop = one.most <= all.least;
        alone = !drop && one.least >= all.most;
        all = {std::max(all.least, one.least), std::max(all.most, one.most)};
      } else if (kind == Kind::intersect) {
        if (!(one.most > 0)) return {0, 0};
        drop = one.least >= all.most;
        alone = !drop && one.most <= all.least;
        all = {std::min(all.least, one.least), std::min(all.most, one.most)};
      } else {  // differ
        drop = 1 - one.most >= all.most;
        all = {std::max(std::min(all.least, 1 - one.most), 0.0f), std::max(std::min(all.most, 1 - one.least), 0.0f)};
        if (!(all.most > 0)) return {0, 0};
      }
      any = true;
      if (drop) {
        out_.resize(start);
      } else if (alone) {
        out_.erase(out_.begin() + static_cast<std::ptrdiff_t>(begin) + 1,
                   out_.begin() + static_cast<std::ptrdiff_t>(start));
        kept = 1;
      } else {
        ++kept;
      }
    }
    if (kind == Kind::blend) {
      unclamped_ = all.most > 1;
      all = {std::min(all.least, 1.0f), std::min(all.most, 1.0f)};
    }
    return all;
  }

  const Tree& tree_;
  const std::vector<Item>& items_;
  std::vector<Item>& out_;
  bool unclamped_ = false;  // the last blend's sum may be above 1
};

}  // namespace

Range cut_down(const Tree& tree, const std::vector<Item>& items, const Box3& box, std::vector<Item>& out) {
  return Cutter(tree, items, out).cut(0, Query(box));
}

}  // namespace ghosttile::density
