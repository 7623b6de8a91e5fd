#include "silvasim/population/corner_overlaps.h"

#include <cmath>

#include "silvasim/base/parallel.h"
#include "silvasim/tiles/overlap.h"

namespace silvasim::population {

namespace {

constexpr std::size_t most_tabled_tiles = 256;

int column_of(std::size_t quarter) { return static_cast<int>(quarter % 2); }
int row_of(std::size_t quarter) { return static_cast<int>(quarter / 2); }

}  // namespace

CornerOverlaps::CornerOverlaps(const tiles::TileSet& set, const tiles::Tiling& tiling)
    : set_(set), tile_count_(set.tiles.size()) {
  for (std::size_t quarter = 0; quarter < quarter_count; ++quarter) {
    for (const tiles::Tile& tile : set.tiles) near_.push_back(sites_near(quarter, tile));
  }
  if (tile_count_ <= most_tabled_tiles) make_table(tiling);
}

std::span<const SitePair> CornerOverlaps::between(QuarterTile a, QuarterTile b, std::vector<SitePair>& scratch) const {
  if (!table_.empty()) return table_[slot(a, b)];
  scratch.clear();
  find(a, b, scratch);
  return scratch;
}

std::vector<std::uint32_t> CornerOverlaps::sites_near(std::size_t quarter, const tiles::Tile& tile) const {
  // The vertex in the tile's own frame: a western tile touches it with its eastern side, a southern one from below.
  const double x = column_of(quarter) == 0 ? set_.side_m : 0;
  const double y = row_of(quarter) == 1 ? set_.side_m : 0;
  const double reach = 4 * set_.most_radius_m;
  std::vector<std::uint32_t> near;
  for (std::size_t i = 0; i < tile.sites.size(); ++i) {
    const tiles::Site& site = tile.sites[i];
    if (std::abs(static_cast<double>(site.x_m) - x) <= reach && std::abs(static_cast<double>(site.y_m) - y) <= reach) {
      near.push_back(static_cast<std::uint32_t>(i));
    }
  }
  return near;
}

void CornerOverlaps::find(QuarterTile a, QuarterTile b, std::vector<SitePair>& pairs) const {
  const double dx = set_.side_m * (column_of(b.quarter) - column_of(a.quarter));
  const double dy = set_.side_m * (row_of(a.quarter) - row_of(b.quarter));
  for (const std::uint32_t i : near_[a.quarter * tile_count_ + a.tile]) {
    for (const std::uint32_t j : near_[b.quarter * tile_count_ + b.tile]) {
      if (a.quarter == b.quarter && j <= i) continue;
      if (tiles::overlap(set_.tiles[a.tile].sites[i], set_.tiles[b.tile].sites[j], dx, dy)) pairs.push_back({i, j});
    }
  }
}

void CornerOverlaps::make_table(const tiles::Tiling& tiling) {
  std::vector<std::uint8_t> needed(quarter_count * quarter_count * tile_count_ * tile_count_, 0);
  const auto need = [&](std::size_t qa, std::size_t a, std::size_t qb, std::size_t b) {
    needed[slot({qa, a}, {qb, b})] = 1;
  };
  for (std::size_t quarter = 0; quarter < quarter_count; ++quarter) {
    for (std::size_t tile = 0; tile < tile_count_; ++tile) need(quarter, tile, quarter, tile);
  }
  for (int row = 0; row < tiling.rows; ++row) {
    for (int column = 0; column < tiling.columns; ++column) {
      const std::size_t here = tiling.at(column, row);
      const bool more_east = column + 1 < tiling.columns, more_south = row + 1 < tiling.rows;
      if (more_east) {
        need(north_west, here, north_east, tiling.at(column + 1, row));
        need(south_west, here, south_east, tiling.at(column + 1, row));
      }
      if (more_south) {
        need(north_west, here, south_west, tiling.at(column, row + 1));
        need(north_east, here, south_east, tiling.at(column, row + 1));
      }
      if (more_east && more_south) {
        need(north_west, here, south_east, tiling.at(column + 1, row + 1));
        need(north_east, tiling.at(column + 1, row), south_west, tiling.at(column, row + 1));
      }
    }
  }
  table_.resize(needed.size());
  base::parallel_for(quarter_count * quarter_count * tile_count_, [&](std::size_t i) {
    const QuarterTile a{i / tile_count_ / quarter_count, i % tile_count_};
    for (std::size_t tile = 0; tile < tile_count_; ++tile) {
      const QuarterTile b{i / tile_count_ % quarter_count, tile};
      if (needed[slot(a, b)]) find(a, b, table_[slot(a, b)]);
    }
  });
}

}  // namespace silvasim::population
