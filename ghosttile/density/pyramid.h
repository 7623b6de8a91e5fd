// The least and the greatest of any rectangle of a raster, quickly: blocks of 2, 4, 8 ... cells a side.
#pragma once

#include <cstddef>
#include <vector>

#include "ghosttile/density/field.h"

namespace ghosttile::density {

class Pyramid {
 public:
  Pyramid() = default;
  // Missing values (NaN) count as 0.
  Pyramid(const std::vector<float>& values, int columns, int rows);

  // Of columns [first_column, last_column] and rows alike, all within the raster: of blocks that cover them.
  Range range(const std::vector<float>& values, int first_column, int first_row, int last_column, int last_row) const;

 private:
  struct Level {
    int columns = 0, rows = 0;
    std::vector<Range> blocks;
  };
  int columns_ = 0;
  std::vector<Level> levels_;  // [k]: blocks of 2^(k+1) cells a side
};

}  // namespace ghosttile::density
