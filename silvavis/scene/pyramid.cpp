#include "silvavis/scene/pyramid.h"

#include <algorithm>
#include <cmath>

#include "silvasim/base/parallel.h"

namespace silvavis::scene {

namespace {

constexpr std::uint16_t nothing_least = 65535, nothing_most = 0;

Pyramid::Level level_over(int columns, int rows) {
  Pyramid::Level level;
  level.columns = (columns + 3) / 4;
  level.rows = (rows + 3) / 4;
  PyramidNode empty;
  empty.least.fill(nothing_least);
  empty.most.fill(nothing_most);
  level.nodes.assign(static_cast<std::size_t>(level.columns) * static_cast<std::size_t>(level.rows), empty);
  return level;
}

}  // namespace

std::size_t Pyramid::bytes() const {
  std::size_t sum = 0;
  for (const Level& level : levels) sum += level.nodes.size() * sizeof(PyramidNode);
  return sum;
}

Pyramid make_pyramid(int columns, int rows, HeightRange whole, const std::function<HeightRange(int, int)>& range_of) {
  Pyramid pyramid;
  pyramid.columns = columns;
  pyramid.rows = rows;
  pyramid.origin_m = whole.least_m;
  // A little more than the range, so that rounding outward never leaves it.
  pyramid.step_m = std::max((whole.most_m - whole.least_m) * 1.0001f, 0.01f) / 65533.0f;
  const auto stored = [&](float height) { return (height - pyramid.origin_m) / pyramid.step_m; };

  Pyramid::Level base = level_over(columns, rows);
  silvasim::base::parallel_for(static_cast<std::size_t>(base.rows), [&](std::size_t node_row) {
    for (int node_column = 0; node_column < base.columns; ++node_column) {
      PyramidNode& node =
          base.nodes[node_row * static_cast<std::size_t>(base.columns) + static_cast<std::size_t>(node_column)];
      for (int child = 0; child < 16; ++child) {
        const int column = node_column * 4 + child % 4, row = static_cast<int>(node_row) * 4 + child / 4;
        if (column >= columns || row >= rows) continue;
        const HeightRange range = range_of(column, row);
        if (range.least_m > range.most_m) continue;
        const auto c = static_cast<std::size_t>(child);
        node.least[c] = static_cast<std::uint16_t>(std::clamp(std::floor(stored(range.least_m)) - 1, 0.0f, 65535.0f));
        node.most[c] = static_cast<std::uint16_t>(std::clamp(std::ceil(stored(range.most_m)) + 1, 0.0f, 65535.0f));
      }
    }
  });
  pyramid.levels.push_back(std::move(base));

  while (pyramid.levels.back().nodes.size() > 1) {
    const Pyramid::Level& below = pyramid.levels.back();
    Pyramid::Level level = level_over(below.columns, below.rows);
    for (int row = 0; row < below.rows; ++row) {
      for (int column = 0; column < below.columns; ++column) {
        const PyramidNode& from = below.nodes[static_cast<std::size_t>(row) * static_cast<std::size_t>(below.columns) +
                                              static_cast<std::size_t>(column)];
        PyramidNode& to = level.nodes[static_cast<std::size_t>(row / 4) * static_cast<std::size_t>(level.columns) +
                                      static_cast<std::size_t>(column / 4)];
        const auto c = static_cast<std::size_t>(row % 4 * 4 + column % 4);
        to.least[c] = *std::min_element(from.least.begin(), from.least.end());
        to.most[c] = *std::max_element(from.most.begin(), from.most.end());
      }
    }
    pyramid.levels.push_back(std::move(level));
  }
  return pyramid;
}

}  // namespace silvavis::scene
