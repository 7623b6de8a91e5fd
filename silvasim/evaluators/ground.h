// The tiled land with its fields, and the sites around a point of it.
//
// Threads: views; what they refer to must outlive them and stay as it is.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "silvasim/base/geometry.h"
#include "silvasim/fields/field_set.h"
#include "silvasim/tiles/tile_set.h"

namespace silvasim::evaluators {

// The land as the layer sees it: which sites there are, and where.
struct Ground {
  const tiles::TileSet& tile_set;
  const tiles::Tiling& tiling;
  base::Point north_west;                     // scene point of the tiling's corner
  const std::vector<std::uint64_t>& offsets;  // first site of each tile position, and the total
  const fields::FieldSet& fields;
};

// One site of the land.
struct SitePlace {
  int column = 0, row = 0;  // tile position
  std::size_t site = 0;     // its id in the tile
  std::uint64_t index = 0;  // over all tile positions and their sites
  base::Point at;           // scene point
  float radius_m = 0;
};

// Visits the sites of the tiles within `reach_m` of a scene point (along x and along y).
template <typename Visit>
void for_sites_around(const Ground& ground, base::Point at, double reach_m, Visit&& visit) {
  const double side = ground.tile_set.side_m;
  const auto tile = [&](double offset, int count) {
    return std::clamp(static_cast<int>(std::floor(offset / side)), 0, count - 1);
  };
  const int columns = ground.tiling.columns, rows = ground.tiling.rows;
  const int last_row = tile(ground.north_west.y - at.y + reach_m, rows);
  const int last_column = tile(at.x - ground.north_west.x + reach_m, columns);
  for (int row = tile(ground.north_west.y - at.y - reach_m, rows); row <= last_row; ++row) {
    for (int column = tile(at.x - ground.north_west.x - reach_m, columns); column <= last_column; ++column) {
      const std::size_t position = ground.tiling.position(column, row);
      const auto& sites = ground.tile_set.tiles[ground.tiling.tiles[position]].sites;
      const base::Point origin{ground.north_west.x + column * side, ground.north_west.y - (row + 1) * side};
      for (std::size_t k = 0; k < sites.size(); ++k) {
        visit(SitePlace{column,
                        row,
                        k,
                        ground.offsets[position] + k,
                        {origin.x + static_cast<double>(sites[k].x_m), origin.y + static_cast<double>(sites[k].y_m)},
                        sites[k].radius_m});
      }
    }
  }
}

// The site whose centre is nearest to the point, among those within a tile's side; none where there is none.
std::optional<SitePlace> nearest_site(const Ground& ground, base::Point at);

}  // namespace silvasim::evaluators
