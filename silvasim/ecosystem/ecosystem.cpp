#include "silvasim/ecosystem/ecosystem.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <mutex>

#include "silvasim/base/parallel.h"

namespace silvasim::ecosystem {

bool operator==(const Terrain& a, const Terrain& b) {
  return a.columns == b.columns && a.rows == b.rows && a.west == b.west && a.north == b.north &&
         a.cell_width_m == b.cell_width_m && a.cell_height_m == b.cell_height_m &&
         a.heights_m.size() == b.heights_m.size() &&
         (a.heights_m.empty() ||
          std::memcmp(a.heights_m.data(), b.heights_m.data(), a.heights_m.size() * sizeof(float)) == 0);
}

std::vector<std::uint64_t> plants_by_species(const Layer& layer) {
  constexpr std::size_t block = 1 << 20;
  const std::size_t none = layer.species.size();  // where sites without plant are counted
  std::vector<std::uint64_t> total(none + 1, 0);
  std::mutex adding;
  base::parallel_for((layer.plants.size() + block - 1) / block, [&](std::size_t i) {
    std::vector<std::uint64_t> counts(none + 1, 0);
    const std::size_t end = std::min(layer.plants.size(), (i + 1) * block);
    for (std::size_t at = i * block; at < end; ++at) ++counts[std::min<std::size_t>(layer.plants[at], none)];
    const std::lock_guard lock(adding);
    for (std::size_t s = 0; s <= none; ++s) total[s] += counts[s];
  });
  total.pop_back();
  return total;
}

std::vector<std::uint64_t> site_offsets(const tiles::TileSet& set, const tiles::Tiling& tiling) {
  std::vector<std::uint64_t> offsets(tiling.tiles.size() + 1, 0);
  for (std::size_t i = 0; i < tiling.tiles.size(); ++i) {
    offsets[i + 1] = offsets[i] + set.tiles[tiling.tiles[i]].sites.size();
  }
  return offsets;
}

base::Point tile_origin(const Layer& layer, int column, int row) {
  const double side = layer.tile_set.side_m;
  return {layer.north_west.x + column * side, layer.north_west.y - (row + 1) * side};
}

double height_at(const Terrain& terrain, base::Point point) {
  if (terrain.columns <= 0 || terrain.rows <= 0) return 0;
  // Between the outermost centres and the edge, the edge's value holds.
  const double u = std::clamp((point.x - terrain.west) / terrain.cell_width_m - 0.5, 0.0, terrain.columns - 1.0);
  const double v = std::clamp((terrain.north - point.y) / terrain.cell_height_m - 0.5, 0.0, terrain.rows - 1.0);
  const int i = std::min(static_cast<int>(u), std::max(terrain.columns - 2, 0));
  const int j = std::min(static_cast<int>(v), std::max(terrain.rows - 2, 0));
  const double s = u - i, t = v - j;
  double sum = 0, weight = 0;
  for (int dj = 0; dj <= 1; ++dj) {
    for (int di = 0; di <= 1; ++di) {
      const int column = std::min(i + di, terrain.columns - 1), row = std::min(j + dj, terrain.rows - 1);
      const float height = terrain.heights_m[static_cast<std::size_t>(row) * static_cast<std::size_t>(terrain.columns) +
                                             static_cast<std::size_t>(column)];
      const double w = (di ? s : 1 - s) * (dj ? t : 1 - t);
      if (std::isnan(height) || w <= 0) continue;
      sum += w * static_cast<double>(height);
      weight += w;
    }
  }
  return weight > 0 ? sum / weight : 0;
}

}  // namespace silvasim::ecosystem
