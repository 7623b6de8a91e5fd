// Wang tiles and their sites.
//
// Units: metres in the tile's own frame, x to the east, y to the north, origin at its south-west corner.
// Source: Silva 2013, section 4.1; docs/reading.md, section A.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace silvasim::tiles {

// A place where a plant may stand. `x`, `y` in [0, side); `radius_m` > 0: the free disc around it.
struct Site {
  float x_m = 0;
  float y_m = 0;
  float radius_m = 0;

  friend bool operator==(const Site&, const Site&) = default;
};

// Edge colours. North and south share one palette, west and east another; both count from 0.
struct EdgeColours {
  std::uint8_t north = 0;
  std::uint8_t east = 0;
  std::uint8_t south = 0;
  std::uint8_t west = 0;

  friend bool operator==(const EdgeColours&, const EdgeColours&) = default;
};

struct Tile {
  EdgeColours colours;
  std::vector<Site> sites;  // the index is the site's id; ordered by y, then x, then radius

  friend bool operator==(const Tile&, const Tile&) = default;
};

struct TileSet {
  double side_m = 0;
  double most_radius_m = 0;  // Rmax: no site's radius is larger
  int colours = 0;           // in each of the two palettes
  int variants = 0;          // tiles for each (north, west) pair
  std::vector<Tile> tiles;   // variant fastest, then west, then north: index = (north * colours + west) * variants + k

  friend bool operator==(const TileSet&, const TileSet&) = default;
};

// Which tile lies where. Row 0 is the northernmost, column 0 the westernmost.
struct Tiling {
  int columns = 0;
  int rows = 0;
  std::vector<std::uint16_t> tiles;  // rows * columns indices into TileSet::tiles, row by row

  // Index of a tile position in the tiling's order.
  std::size_t position(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
  std::uint16_t at(int column, int row) const { return tiles[position(column, row)]; }

  friend bool operator==(const Tiling&, const Tiling&) = default;
};

}  // namespace silvasim::tiles
