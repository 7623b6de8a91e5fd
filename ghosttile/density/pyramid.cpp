#include "ghosttile/density/pyramid.h"

#include <algorithm>
#include <cmath>

namespace ghosttile::density {

namespace {

Range range_of(float value) {
  const float known = std::isnan(value) ? 0 : value;
  return {known, known};
}

Range hull(const Range& a, const Range& b) { return {std::min(a.least, b.least), std::max(a.most, b.most)}; }

// at(column, row) over a rectangle
template <class At>
Range range_over(int first_column, int first_row, int last_column, int last_row, const At& at) {
  Range all = at(first_column, first_row);
  for (int row = first_row; row <= last_row; ++row)
    for (int column = first_column; column <= last_column; ++column) all = hull(all, at(column, row));
  return all;
}

std::size_t index(int column, int row, int columns) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
}

}  // namespace

Pyramid::Pyramid(const std::vector<float>& values, int columns, int rows) : columns_(columns) {
  int wide = columns, high = rows;
  while (wide > 1 || high > 1) {
    Level level{(wide + 1) / 2, (high + 1) / 2, {}};
    level.blocks.reserve(static_cast<std::size_t>(level.columns) * static_cast<std::size_t>(level.rows));
    for (int row = 0; row < level.rows; ++row) {
      for (int column = 0; column < level.columns; ++column) {
        level.blocks.push_back(range_over(2 * column, 2 * row, std::min(2 * column + 1, wide - 1),
                                          std::min(2 * row + 1, high - 1), [&](int c, int r) {
                                            const std::size_t i = index(c, r, wide);
                                            return levels_.empty() ? range_of(values[i]) : levels_.back().blocks[i];
                                          }));
      }
    }
    wide = level.columns;
    high = level.rows;
    levels_.push_back(std::move(level));
  }
}

Range Pyramid::range(const std::vector<float>& values, int first_column, int first_row, int last_column,
                     int last_row) const {
  constexpr int most_blocks = 4;
  int level = 0;
  while (((last_column - first_column) >> level) >= most_blocks || ((last_row - first_row) >> level) >= most_blocks)
    ++level;
  return range_over(first_column >> level, first_row >> level, last_column >> level, last_row >> level,
                    [&](int c, int r) {
                      if (level == 0) return range_of(values[index(c, r, columns_)]);
                      const Level& of = levels_[static_cast<std::size_t>(level) - 1];
                      return of.blocks[index(c, r, of.columns)];
                    });
}

}  // namespace ghosttile::density
