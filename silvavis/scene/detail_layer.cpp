#include "silvavis/scene/detail_layer.h"

#include <algorithm>
#include <bit>

namespace silvavis::scene {

namespace {

const DetailColumn* column_at(const DetailLayer& layer, const V3d& at, float& least_m, float& most_m) {
  const double u = (at.x - layer.corner.x) / layer.side_m, v = (at.y - layer.corner.y) / layer.side_m;
  const double across = std::ldexp(1.0, 2 * layer.levels);
  if (!(u >= 0 && v >= 0 && u < across && v < across)) return nullptr;
  const auto column = static_cast<std::uint32_t>(u), row = static_cast<std::uint32_t>(v);
  std::uint32_t node = 0;
  for (int level = layer.levels - 1;; --level) {
    const DetailNode& here = layer.nodes[node];
    const std::uint32_t child = (row >> (2 * level) & 3) * 4 + (column >> (2 * level) & 3);
    if ((here.children >> child & 1) == 0) return nullptr;
    node = here.first + static_cast<std::uint32_t>(std::popcount(here.children & ((1u << child) - 1)));
    least_m = here.least_m[child];
    most_m = here.most_m[child];
    if (level == 0) return &layer.columns[node];
  }
}

}  // namespace

std::uint64_t DetailLayer::instances_bytes() const {
  return nodes.size() * sizeof(DetailNode) + columns.size() * sizeof(DetailColumn) + tiles.size() * sizeof(DetailTile) +
         chosen.size() * sizeof(chosen[0]) + group_bounds.size();
}

std::uint32_t detail_number(const DetailLayer& layer, std::uint32_t slot) {
  // The last tile that begins at the slot or before.
  const auto after = std::upper_bound(layer.tiles.begin(), layer.tiles.end() - 1, slot,
                                      [](std::uint32_t at, const DetailTile& tile) { return at < tile.first; });
  const DetailTile& tile = *(after - 1);
  return tile.number + (slot - tile.first);
}

DetailCover detail_cover(const DetailLayer& layer, const V3d& at, float width_m) {
  DetailCover cover;
  if (!layer.fades || layer.nodes.empty() || layer.part_faded.empty()) return cover;
  const auto steps = static_cast<float>(layer.part_faded.size() - 1);
  const float place = std::min(width_m / layer.most_faded(), 1.0f) * steps;
  const auto below = std::min(static_cast<std::size_t>(place), layer.part_faded.size() - 2);
  const float between = place - static_cast<float>(below);
  const float part = layer.part_faded[below] * (1 - between) + layer.part_faded[below + 1] * between;
  if (!(part > 0)) return cover;
  float least_m = 0, most_m = 0;
  const DetailColumn* const column = column_at(layer, at, least_m, most_m);
  // What hangs above the ground does not lie on it.
  constexpr double near_m = 0.5;
  if (!column || at.z < static_cast<double>(least_m) - near_m || at.z > static_cast<double>(most_m) + near_m)
    return cover;
  const float depth = static_cast<float>(column->depth) * detail_depth_step * layer.depth_scale;
  cover.gap_light = 1 - part * (1 - layer.gap_light);
  cover.share = part * (1 - std::exp(-depth));
  for (int c = 0; c < 3; ++c) {
    const float root = static_cast<float>(column->colour[static_cast<std::size_t>(c)]) * (1.0f / 255);
    cover.colour[c] = root * root * layer.tint[c];
  }
  return cover;
}

}  // namespace silvavis::scene
