#include "ghosttile/density/tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "assets/grown/draws.h"
#include "silvasim/base/random.h"

namespace ghosttile::density {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const Box3 everywhere{V3d(-infinity), V3d(infinity)};
const Box3 nowhere{V3d(infinity), V3d(-infinity)};

Box3 hull(const Box3& a, const Box3& b) {
  Box3 box;
  for (int k = 0; k < 3; ++k) {
    box.least[k] = std::min(a.least[k], b.least[k]);
    box.most[k] = std::max(a.most[k], b.most[k]);
  }
  return box;
}

Box3 common(const Box3& a, const Box3& b) {
  Box3 box;
  for (int k = 0; k < 3; ++k) {
    box.least[k] = std::max(a.least[k], b.least[k]);
    box.most[k] = std::min(a.most[k], b.most[k]);
    if (box.least[k] > box.most[k]) return nowhere;
  }
  return box;
}

Box3 grown(const Box3& box, double by) { return {box.least - V3d(by), box.most + V3d(by)}; }

class Worker {
 public:
  Worker() : tree_(std::make_shared<Tree>()) {}

  void add(const Node& node) {
    const std::size_t begin = items_.size();
    items_.push_back({node.kind, 0, 1, static_cast<float>(node.value)});
    if (node.kind == Kind::curve) {
      items_[begin].kind = Kind::unite;
      for (std::size_t i = 0; i + 1 < node.points.size(); ++i) {
        Leaf leaf = leaf_of(node);
        leaf.kind = Kind::segment;
        between(leaf, node.points[i], node.points[i + 1]);
        push(leaf);
      }
    } else if (is_operator(node.kind)) {
      if (node.kind == Kind::warp) {
        items_[begin].index = static_cast<std::uint32_t>(tree_->warps.size());
        silvasim::base::Stream stream(node.seed, silvasim::base::Purpose::density_warp);
        tree_->warps.push_back({node.size.x, node.radius_m, stream.next_u32()});
      }
      for (const Node& child : node.children) add(child);
    } else if (node.kind != Kind::constant) {
      items_.pop_back();
      Leaf leaf = leaf_of(node);
      if (node.kind == Kind::segment || node.kind == Kind::cylinder) between(leaf, node.points[0], node.points[1]);
      push(leaf);
    }
    items_[begin].span = static_cast<std::uint32_t>(items_.size() - begin);
  }

  Cut cut() && { return {std::move(tree_), std::move(items_)}; }

 private:
  Leaf leaf_of(const Node& node) {
    Leaf leaf;
    leaf.kind = node.kind;
    if (!node.points.empty()) leaf.at = node.points[0];
    if (node.kind == Kind::disc) leaf.axis = node.axis * (1 / std::sqrt(node.axis.dot(node.axis)));
    if (node.kind == Kind::box) {
      leaf.half = node.size;
      const double turn_deg = node.turn_deg - 360 * std::floor(node.turn_deg / 360);
      const auto turn = assets::grown::sin_cos(static_cast<float>(turn_deg * (3.14159265358979324 / 180)));
      const double c = static_cast<double>(turn.cos), s = static_cast<double>(turn.sin),
                   norm = std::sqrt(c * c + s * s);
      leaf.cos_turn = c / norm;
      leaf.sin_turn = s / norm;
    }
    if (node.kind == Kind::disc || node.kind == Kind::cylinder || node.kind == Kind::sphere) leaf.size_m = node.size.x;
    leaf.radius_m = node.radius_m;
    leaf.core = node.core;
    leaf.from_m = node.from_m;
    leaf.to_m = node.to_m;
    if (node.plane) {
      auto& planes = tree_->planes;
      const auto found = std::find(planes.begin(), planes.end(), node.plane);
      leaf.plane = static_cast<std::uint32_t>(found - planes.begin());
      if (found == planes.end()) planes.push_back(node.plane);
    }
    return leaf;
  }

  static void between(Leaf& leaf, const V3d& from, const V3d& to) {
    const V3d way = to - from;
    leaf.at = from;
    leaf.length_m = std::sqrt(way.dot(way));
    leaf.axis = leaf.length_m > 0 ? way / leaf.length_m : V3d(0, 0, 1);
  }

  void push(Leaf leaf) {
    if (leaf.kind != Kind::segment && leaf.kind != Kind::cylinder) leaf.length_m = 0;
    leaf.reach_m =
        leaf.radius_m + leaf.size_m + std::sqrt(leaf.half.dot(leaf.half)) + std::abs(leaf.from_m) + std::abs(leaf.to_m);
    leaf.bounds = grown(solid_bounds(leaf), leaf.radius_m + slack * leaf.reach_m);
    items_.push_back({leaf.kind, static_cast<std::uint32_t>(tree_->leaves.size()), 1, 0});
    tree_->leaves.push_back(leaf);
  }

  Box3 solid_bounds(const Leaf& leaf) const {
    const V3d& a = leaf.axis;
    Box3 box{leaf.at, leaf.at};
    switch (leaf.kind) {
      case Kind::segment:
      case Kind::cylinder:
        box = hull(box, {leaf.at + a * leaf.length_m, leaf.at + a * leaf.length_m});
        [[fallthrough]];
      case Kind::disc:
        // A disc at right angles to the axis spans sqrt(1 - a^2) of its radius along each coordinate.
        for (int k = 0; k < 3; ++k) {
          const double across = leaf.size_m * std::sqrt(std::max(0.0, 1 - a[k] * a[k]));
          box.least[k] -= across;
          box.most[k] += across;
        }
        return box;
      case Kind::sphere:
        return grown(box, leaf.size_m);
      case Kind::box: {
        const double c = std::abs(leaf.cos_turn), s = std::abs(leaf.sin_turn);
        const V3d half(c * leaf.half.x + s * leaf.half.y, s * leaf.half.x + c * leaf.half.y, leaf.half.z);
        return {leaf.at - half, leaf.at + half};
      }
      case Kind::layer:
      case Kind::above: {
        const Range height = tree_->planes[leaf.plane]->bounds(-infinity, -infinity, infinity, infinity);
        box = everywhere;
        box.least.z = static_cast<double>(height.least) + leaf.from_m;
        if (leaf.kind == Kind::layer) box.most.z = static_cast<double>(height.most) + leaf.to_m;
        return box;
      }
      case Kind::column:
        return everywhere;
      default:
        return box;
    }
  }

  std::shared_ptr<Tree> tree_;
  std::vector<Item> items_;
};

Box3 bounds_at(const Tree& tree, const std::vector<Item>& items, std::size_t at) {
  const Item& item = items[at];
  if (item.kind == Kind::constant) return item.value > 0 ? everywhere : nowhere;
  if (!is_operator(item.kind)) return tree.leaves[item.index].bounds;
  Box3 box = bounds_at(tree, items, at + 1);
  if (item.kind == Kind::warp) return grown(box, tree.warps[item.index].far_m * (1 + slack));
  if (item.kind == Kind::scale) return item.value > 0 ? box : nowhere;
  if (item.kind == Kind::differ) return box;
  for (std::size_t child = at + 1 + items[at + 1].span; child < at + item.span; child += items[child].span) {
    const Box3 other = bounds_at(tree, items, child);
    const bool all = item.kind == Kind::intersect || item.kind == Kind::multiply;
    box = all ? common(box, other) : hull(box, other);
  }
  return box;
}

}  // namespace

Cut worked_out(const Node& node) {
  Worker worker;
  worker.add(node);
  return std::move(worker).cut();
}

Box3 bounds_of(const Tree& tree, const std::vector<Item>& items) { return bounds_at(tree, items, 0); }

}  // namespace ghosttile::density
