// The two ways to fill a tile set, called by fill_tiles(). `set` comes with its colours and without sites.
#pragma once

#include <cstdint>

#include "silvasim/base/random.h"
#include "silvasim/tiles/disc_grid.h"
#include "silvasim/tiles/radii.h"
#include "silvasim/tiles/tile_set.h"

namespace silvasim::tiles {

// What both modes work with.
struct Filling {
  TileSet& set;
  const Radii& radii;
  double sites_per_m2 = 0;
  std::uint64_t seed = 0;
  std::uint32_t layer = 0;
};

void fill_paper(const Filling& filling);
void fill_seamless(const Filling& filling);

// What a stream of darts is for; part of what a seed means.
enum class Piece : std::uint32_t { tile = 0, vertex = 1, horizontal_strip = 2, vertical_strip = 3, interior = 4 };

base::Stream darts_for(const Filling& filling, Piece piece, std::size_t index);

inline Disc disc_of(const Site& site, double shift_x, double shift_y) {
  return {static_cast<double>(site.x_m) + shift_x, static_cast<double>(site.y_m) + shift_y,
          static_cast<double>(site.radius_m)};
}

// Appends the discs that lie in the tile whose south-west corner is at (west, south).
void append_sites(std::vector<Site>& sites, const std::vector<Disc>& discs, double west, double south, double side);

}  // namespace silvasim::tiles
