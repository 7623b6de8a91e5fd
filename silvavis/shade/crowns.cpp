#include "silvavis/shade/crowns.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace silvavis::shade {

namespace {

void add_leaf(const scene::PlantLayer& layer, const scene::TileSites& tile, std::size_t position, scene::SiteLeaf leaf,
              float x, float y, Crowns& crowns) {
  const std::uint32_t last = std::min(leaf.first_slot + leaf.slots, tile.count);
  for (std::uint32_t slot = leaf.first_slot; slot < last; ++slot) {
    const float dx = x - tile.x_m[slot], dy = y - tile.y_m[slot], radius = tile.radius_m[slot];
    const float squared = dx * dx + dy * dy, reach = std::max(1.25f * radius, radius + Crowns::gap_m);
    if (squared >= reach * reach) continue;
    const std::uint8_t species = layer.plant_species[layer.first_slot[position] + slot];
    if (species == scene::no_species || layer.species[species].variants == 0) continue;
    const float away = std::sqrt(squared) / radius;
    crowns.cover = std::max(crowns.cover, std::min(1.0f, (1.25f - away) * 1.6f));
    crowns.near = std::max(crowns.near, std::min(1.0f, 1 - (away - 1) * radius / Crowns::gap_m));
    crowns.foot = std::max(crowns.foot, 1 - 5 * away);
  }
}

void add_tile(const scene::PlantLayer& layer, int column, int row, double x, double y, Crowns& crowns) {
  if (column < 0 || row < 0 || column >= layer.columns || row >= layer.rows) return;
  const std::size_t position = layer.position(column, row);
  const scene::TileSites& tile = layer.tile_sites[layer.tiles[position]];
  if (tile.nodes.empty()) return;
  const auto u = static_cast<float>(x - layer.west - column * layer.tile_side_m),
             v = static_cast<float>(y - layer.south - row * layer.tile_side_m);
  std::array<std::uint32_t, 16 * scene::most_depth> waiting;
  std::size_t count = 0;
  waiting[count++] = 0;
  while (count > 0) {
    const scene::SiteNode& node = tile.nodes[waiting[--count]];
    for (std::uint32_t child = 0; child < 16; ++child) {
      constexpr float gap = Crowns::gap_m;
      if (u < node.least_x[child] - gap || u > node.most_x[child] + gap || v < node.least_y[child] - gap ||
          v > node.most_y[child] + gap)
        continue;
      if (node.above_leaves) {
        add_leaf(layer, tile, position, scene::SiteLeaf::of(node.children[child]), u, v, crowns);
      } else {
        waiting[count++] = node.children[child];
      }
    }
  }
}

}  // namespace

Crowns crowns_over(const scene::Scene& scene, double x, double y) {
  Crowns crowns;
  for (const scene::PlantLayer& layer : scene.layers) {
    if (!(layer.tile_side_m > 0)) continue;
    const double u = (x - layer.west) / layer.tile_side_m, v = (y - layer.south) / layer.tile_side_m;
    if (!(u > -1 && v > -1 && u < layer.columns + 1 && v < layer.rows + 1)) continue;
    const int column = static_cast<int>(std::floor(u)), row = static_cast<int>(std::floor(v));
    // Discs reach into the tiles beside, at most half a tile.
    const int beside = u - column < 0.5 ? -1 : 1, above = v - row < 0.5 ? -1 : 1;
    for (const int i : {0, beside})
      for (const int j : {0, above}) add_tile(layer, column + i, row + j, x, y, crowns);
  }
  return crowns;
}

}  // namespace silvavis::shade
