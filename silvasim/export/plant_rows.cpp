#include "silvasim/export/plant_rows.h"

#include <algorithm>

namespace silvasim::exports {

namespace {

constexpr std::uint64_t portion_sites = 1 << 16;

// Around all tiles, which may reach beyond the extent.
base::Box box_of_tiles(const ecosystem::Ecosystem& ecosystem) {
  base::Box box{0, 0, 1, 1};
  bool first = true;
  for (const ecosystem::Layer& layer : ecosystem.layers) {
    const double side = layer.tile_set.side_m;
    const base::Box tiles{layer.north_west.x, layer.north_west.y - std::max(1, layer.tiling.rows) * side,
                          layer.north_west.x + std::max(1, layer.tiling.columns) * side, layer.north_west.y};
    if (first) box = tiles;
    first = false;
    box = {std::min(box.west, tiles.west), std::min(box.south, tiles.south), std::max(box.east, tiles.east),
           std::max(box.north, tiles.north)};
  }
  return box;
}

}  // namespace

PlantRows::PlantRows(const ecosystem::Ecosystem& ecosystem, bool with_geographic)
    : ecosystem_(ecosystem), geographic_(with_geographic ? ecosystem.crs_wkt : std::string(), box_of_tiles(ecosystem)) {
  for (std::size_t l = 0; l < ecosystem.layers.size(); ++l) {
    const ecosystem::Layer& layer = ecosystem.layers[l];
    offsets_.push_back(ecosystem::site_offsets(layer.tile_set, layer.tiling));
    const auto& offsets = offsets_.back();
    for (std::size_t first = 0; first + 1 < offsets.size();) {
      std::size_t last = first + 1;
      while (last + 1 < offsets.size() && offsets[last + 1] - offsets[first] <= portion_sites) ++last;
      portions_.push_back({l, first, last});
      first = last;
    }
  }
}

bool PlantRows::has_probabilities() const {
  return std::any_of(ecosystem_.layers.begin(), ecosystem_.layers.end(),
                     [](const ecosystem::Layer& layer) { return !layer.probabilities.empty(); });
}

}  // namespace silvasim::exports
