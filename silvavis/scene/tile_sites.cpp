#include "silvavis/scene/tile_sites.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace silvavis::scene {

namespace {

constexpr std::uint32_t leaf = SiteLeaf::least_slots;

struct Range {
  std::uint32_t first = 0, last = 0;  // of `order`
  std::uint32_t count() const { return last - first; }
};

struct Builder {
  const std::vector<silvasim::tiles::Site>& sites;
  std::vector<std::uint32_t> order;
  TileSites& out;

  // Cuts a range of more than a leaf at a multiple of whole leaves next to its median.
  std::pair<Range, Range> cut(Range range) {
    float west = std::numeric_limits<float>::max(), east = -west, south = west, north = -west;
    for (std::uint32_t i = range.first; i < range.last; ++i) {
      const auto& site = sites[order[i]];
      west = std::min(west, site.x_m);
      east = std::max(east, site.x_m);
      south = std::min(south, site.y_m);
      north = std::max(north, site.y_m);
    }
    const bool along_x = east - west > north - south;
    const std::uint32_t leaves = (range.count() + leaf - 1) / leaf;
    const std::uint32_t middle = range.first + (leaves + 1) / 2 * leaf;
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
      const float at_a = along_x ? sites[a].x_m : sites[a].y_m, at_b = along_x ? sites[b].x_m : sites[b].y_m;
      return at_a != at_b ? at_a < at_b : a < b;
    };
    std::nth_element(order.begin() + range.first, order.begin() + middle, order.begin() + range.last, before);
    return {{range.first, middle}, {middle, range.last}};
  }

  void bound(SiteNode& node, std::size_t child, Range range, float most_reach) const {
    for (std::uint32_t i = range.first; i < range.last; ++i) {
      const auto& site = sites[order[i]];
      const float reach = site.radius_m * most_reach;
      node.least_x[child] = std::min(node.least_x[child], site.x_m - reach);
      node.most_x[child] = std::max(node.most_x[child], site.x_m + reach);
      node.least_y[child] = std::min(node.least_y[child], site.y_m - reach);
      node.most_y[child] = std::max(node.most_y[child], site.y_m + reach);
    }
  }

  // Fills nodes[index] for the range.
  void build(std::uint32_t index, Range range, float most_reach) {
    std::vector<Range> children{range};
    // Cut the largest part until there are sixteen, or all are the smallest leaves.
    while (children.size() < 16) {
      const auto largest = std::max_element(children.begin(), children.end(),
                                            [](const Range& a, const Range& b) { return a.count() < b.count(); });
      if (largest->count() <= leaf) break;
      const auto [low, high] = cut(*largest);
      *largest = low;
      children.insert(largest + 1, high);
    }
    const bool above_leaves =
        std::all_of(children.begin(), children.end(), [](const Range& child) { return child.count() <= 2 * leaf; });
    SiteNode node;
    node.least_x.fill(std::numeric_limits<float>::max());
    node.least_y = node.least_x;
    node.most_x.fill(std::numeric_limits<float>::lowest());
    node.most_y = node.most_x;
    node.above_leaves = above_leaves;
    const auto first = static_cast<std::uint32_t>(out.nodes.size());
    // A part that is a leaf among larger ones becomes a node with a few children.
    if (!above_leaves) out.nodes.resize(out.nodes.size() + children.size());
    for (std::size_t c = 0; c < children.size(); ++c) {
      const Range& child = children[c];
      node.children[c] = above_leaves ? SiteLeaf{child.first, child.count() > leaf ? 2 * leaf : leaf}.packed()
                                      : first + static_cast<std::uint32_t>(c);
      if (!above_leaves) build(node.children[c], child, most_reach);
      bound(node, c, child, most_reach);
    }
    out.nodes[index] = node;
  }
};

}  // namespace

TileSites make_tile_sites(const silvasim::tiles::Tile& tile, float most_reach) {
  TileSites out;
  out.count = static_cast<std::uint32_t>(tile.sites.size());
  if (out.count == 0) return out;
  Builder builder{tile.sites, std::vector<std::uint32_t>(out.count), out};
  std::iota(builder.order.begin(), builder.order.end(), 0u);
  out.nodes.resize(1);
  builder.build(0, {0, out.count}, most_reach);
  const std::size_t padded = (out.count + leaf - 1) / leaf * leaf;
  out.x_m.assign(padded, 0);
  out.y_m.assign(padded, 0);
  out.radius_m.assign(padded, -1);
  out.reach_m.assign(padded, -1);
  out.site_ids = builder.order;
  for (std::uint32_t slot = 0; slot < out.count; ++slot) {
    const auto& site = tile.sites[out.site_ids[slot]];
    out.x_m[slot] = site.x_m;
    out.y_m[slot] = site.y_m;
    out.radius_m[slot] = site.radius_m;
    out.reach_m[slot] = site.radius_m * most_reach;
  }
  return out;
}

}  // namespace silvavis::scene
