// What the tests measure on tiles and tilings, by the plainest means that are fast enough.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "silvasim/base/random.h"
#include "silvasim/tiles/fill.h"
#include "silvasim/tiles/overlap.h"
#include "silvasim/tiles/tile_land.h"

namespace silvasim::tiles {

inline config::TileSettings settings_with(config::TileMode mode, double least, double most, double side,
                                          double coverage = 0.5, int colours = 3, int variants = 2) {
  config::TileSettings settings;
  settings.mode = mode;
  settings.least_radius_m = least;
  settings.most_radius_m = most;
  settings.side_m = side;
  settings.coverage = coverage;
  settings.colours = colours;
  settings.variants = variants;
  return settings;
}

// Distance (Chebyshev) from the nearest corner of the tile, or from the nearest edge.
inline double from_vertex(double x, double y, double side) {
  return std::max(std::min(x, side - x), std::min(y, side - y));
}
inline double from_edge(double x, double y, double side) { return std::min({x, side - x, y, side - y}); }

// Calls visit(a, b) for each overlapping pair of sites of two tiles, the second lying `dx`, `dy` tiles away.
template <typename Visit>
void overlaps_between(const Tile& a, const Tile& b, int dx, int dy, double side, double most_radius, Visit&& visit) {
  const double reach = 2 * most_radius;
  const auto near = [&](const Site& site, int x, int y) {
    const double sx = static_cast<double>(site.x_m), sy = static_cast<double>(site.y_m);
    return !(x > 0 && sx < side - reach) && !(x < 0 && sx > reach) && !(y > 0 && sy < side - reach) &&
           !(y < 0 && sy > reach);
  };
  std::vector<const Site*> others;
  for (const Site& site : b.sites) {
    if (near(site, -dx, -dy)) others.push_back(&site);
  }
  for (const Site& site : a.sites) {
    if (!near(site, dx, dy)) continue;
    for (const Site* other : others) {
      if (overlap(site, *other, dx * side, dy * side)) visit(site, *other);
    }
  }
}

// Is a point of a tiling under a disc? Looks up the sites by a grid of cells of the tile.
class Ground {
 public:
  Ground(const TileSet& set, const Tiling& tiling) : set_(set), tiling_(tiling) {
    cells_ = std::max(1, static_cast<int>(set.side_m / set.most_radius_m));
    by_cell_.resize(set.tiles.size() * static_cast<std::size_t>(cells_ * cells_));
    for (std::size_t t = 0; t < set.tiles.size(); ++t) {
      for (const Site& site : set.tiles[t].sites) {
        by_cell_[index(t, cell(static_cast<double>(site.x_m)), cell(static_cast<double>(site.y_m)))].push_back(site);
      }
    }
  }

  // `x` to the east and `y` to the north of the tiling's south-west corner, metres.
  bool covered(double x, double y) const {
    const double cell_size = set_.side_m / cells_;
    const int cx = static_cast<int>(std::floor(x / cell_size)), cy = static_cast<int>(std::floor(y / cell_size));
    for (int j = cy - 2; j <= cy + 2; ++j) {
      for (int i = cx - 2; i <= cx + 2; ++i) {
        if (i < 0 || j < 0 || i >= cells_ * tiling_.columns || j >= cells_ * tiling_.rows) continue;
        const int column = i / cells_, row = j / cells_;
        const std::size_t t = tiling_.at(column, tiling_.rows - 1 - row);
        for (const Site& site : by_cell_[index(t, i % cells_, j % cells_)]) {
          const double dx = x - column * set_.side_m - static_cast<double>(site.x_m);
          const double dy = y - row * set_.side_m - static_cast<double>(site.y_m);
          const double r = static_cast<double>(site.radius_m);
          if (dx * dx + dy * dy < r * r) return true;
        }
      }
    }
    return false;
  }

 private:
  int cell(double x) const { return std::min(cells_ - 1, static_cast<int>(x / set_.side_m * cells_)); }
  std::size_t index(std::size_t tile, int i, int j) const {
    return (tile * static_cast<std::size_t>(cells_) + static_cast<std::size_t>(j)) * static_cast<std::size_t>(cells_) +
           static_cast<std::size_t>(i);
  }

  const TileSet& set_;
  const Tiling& tiling_;
  int cells_ = 1;
  std::vector<std::vector<Site>> by_cell_;
};

}  // namespace silvasim::tiles
