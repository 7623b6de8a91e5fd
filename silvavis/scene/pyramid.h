// Least and greatest heights over a grid, in levels of 4 x 4: what lets a ray skip land that it passes above or below.
//
// Level 0 has a node for each 4 x 4 items, the last level one node. An item's box is its cell grown sideways by `margin_m`
// (plants overhang their tile). Heights are rounded outward to 1/65535 of the whole range. Memory: 4.3 bytes an item.
// Source: Silva 2013, section 5 ("inner nodes store the minimal and maximal heights of the children"); Dietrich, Marmitt and
// Slusallek 2006.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace silvavis::scene {

struct PyramidNode {
  // [y * 4 + x]; least > most: nothing there
  std::array<std::uint16_t, 16> least, most;
};

struct Pyramid {
  struct Level {
    int columns = 0, rows = 0;
    std::vector<PyramidNode> nodes;  // row by row
  };
  int columns = 0, rows = 0;  // of items
  float west = 0, south = 0;  // of item (0, 0)
  float cell_x_m = 1, cell_y_m = 1;
  float margin_m = 0;
  float origin_m = 0, step_m = 0;  // height = origin + step * stored
  std::vector<Level> levels;

  std::size_t bytes() const;
};

struct HeightRange {
  float least_m = 0, most_m = -1;  // least > most: nothing there
};

// `whole` holds every item's range; `range_of(column, row)` may be called from several threads.
Pyramid make_pyramid(int columns, int rows, HeightRange whole, const std::function<HeightRange(int, int)>& range_of);

}  // namespace silvavis::scene
