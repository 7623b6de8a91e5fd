#include "silvasim/fields/wetness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <queue>

#include "silvasim/base/math.h"
#include "silvasim/fields/terrain.h"

namespace silvasim::fields {

namespace {

constexpr std::array<int, 8> step_column = {1, 1, 0, -1, -1, -1, 0, 1};
constexpr std::array<int, 8> step_row = {0, 1, 1, 1, 0, -1, -1, -1};

// The order in which a flood that rises from the outside reaches the cells, and from where.
struct Flood {
  std::vector<float> level;          // the filled height
  std::vector<std::uint32_t> order;  // cells with data, never before the one they drain to
  std::vector<std::uint32_t> from;   // the neighbour that let the flood in; the cell itself at an outlet
};

Flood flood(const Raster& heights) {
  const int columns = heights.columns, rows = heights.rows;
  const std::size_t count = heights.values.size();
  Flood result;
  result.level = heights.values;
  result.from.assign(count, 0);
  result.order.reserve(count);
  std::vector<bool> reached(count);

  // Cells waiting above the present water line, lowest first; equal ones in the order in which they came.
  struct Waiting {
    float level;
    std::uint32_t number, cell;
  };
  const auto later = [](const Waiting& a, const Waiting& b) {
    return a.level != b.level ? a.level > b.level : a.number > b.number;
  };
  std::priority_queue<Waiting, std::vector<Waiting>, decltype(later)> rim(later);
  std::uint32_t number = 0;

  // Outlets: cells on the grid's rim or beside one without data.
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (std::isnan(heights.at(column, row))) continue;
      bool outlet = row == 0 || column == 0 || row == rows - 1 || column == columns - 1;
      for (std::size_t k = 0; k < 8 && !outlet; ++k)
        outlet = std::isnan(heights.at(column + step_column[k], row + step_row[k]));
      if (!outlet) continue;
      const auto cell =
          static_cast<std::uint32_t>(row) * static_cast<std::uint32_t>(columns) + static_cast<std::uint32_t>(column);
      reached[cell] = true;
      result.from[cell] = cell;
      rim.push({heights.values[cell], number++, cell});
    }
  }
  // Inside a depression the order of coming is the order of height, and a plain queue serves.
  std::queue<std::uint32_t> pit;
  while (!rim.empty() || !pit.empty()) {
    std::uint32_t cell = 0;
    if (!pit.empty()) {
      cell = pit.front();
      pit.pop();
    } else {
      cell = rim.top().cell;
      rim.pop();
    }
    result.order.push_back(cell);
    const int column = static_cast<int>(cell % static_cast<std::uint32_t>(columns));
    const int row = static_cast<int>(cell / static_cast<std::uint32_t>(columns));
    for (std::size_t k = 0; k < 8; ++k) {
      const int c = column + step_column[k], r = row + step_row[k];
      if (c < 0 || c >= columns || r < 0 || r >= rows) continue;
      const auto next =
          static_cast<std::uint32_t>(r) * static_cast<std::uint32_t>(columns) + static_cast<std::uint32_t>(c);
      if (reached[next] || std::isnan(heights.values[next])) continue;
      reached[next] = true;
      result.from[next] = cell;
      if (result.level[next] <= result.level[cell]) {
        result.level[next] = result.level[cell];
        pit.push(next);
      } else {
        rim.push({result.level[next], number++, next});
      }
    }
  }
  return result;
}

}  // namespace

std::vector<float> filled_heights(const Raster& heights) { return flood(heights).level; }

std::vector<double> catchment_area_m2(const Raster& heights) {
  const int columns = heights.columns;
  const double width = heights.cell_width, height = heights.cell_height;
  const Flood water = flood(heights);
  std::vector<double> area(heights.values.size());
  for (const std::uint32_t cell : water.order) area[cell] = width * height;

  // Slope times contour length for a drop of one metre. The contour facing a side is half as long as the side, one
  // facing a corner a quarter of the diagonal: 0.5 and 0.354 of a square cell's side.
  std::array<double, 8> share{};
  for (std::size_t k = 0; k < 8; ++k) {
    share[k] = step_row[k] == 0 ? 0.5 * height / width : step_column[k] == 0 ? 0.5 * width / height : 0.25;
  }

  // From the last reached, thus highest, to the first: what lies above has always given its water before.
  for (auto it = water.order.rbegin(); it != water.order.rend(); ++it) {
    const std::uint32_t cell = *it;
    if (water.from[cell] == cell) continue;  // an outlet
    const int column = static_cast<int>(cell % static_cast<std::uint32_t>(columns));
    const int row = static_cast<int>(cell / static_cast<std::uint32_t>(columns));
    std::array<double, 8> weight{};
    double total = 0;
    for (std::size_t k = 0; k < 8; ++k) {
      // Not on the rim (that is all outlets), so each neighbour exists and has data.
      const float level = water.level[static_cast<std::size_t>(row + step_row[k]) * static_cast<std::size_t>(columns) +
                                      static_cast<std::size_t>(column + step_column[k])];
      if (level >= water.level[cell]) continue;
      weight[k] = (double(water.level[cell]) - level) * share[k];
      total += weight[k];
    }
    if (total == 0) {
      area[water.from[cell]] += area[cell];
      continue;
    }
    for (std::size_t k = 0; k < 8; ++k) {
      if (weight[k] == 0) continue;
      area[static_cast<std::size_t>(row + step_row[k]) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column + step_column[k])] += area[cell] * (weight[k] / total);
    }
  }
  return area;
}

Raster wetness_index(const Raster& heights) {
  constexpr double least_tangent = 0.001;
  const std::vector<double> area = catchment_area_m2(heights);
  Raster result = derive(config::TerrainMeasure::northness, heights);
  const Raster eastness = derive(config::TerrainMeasure::eastness, heights);
  // Contour length of a cell: its side, by the mean of both where they differ.
  const double contour = std::sqrt(heights.cell_width * heights.cell_height);
  for (std::size_t i = 0; i < area.size(); ++i) {
    if (std::isnan(heights.values[i])) continue;
    // sin of the slope from its two parts; tan = sin / sqrt(1 - sin^2).
    const double sine2 = double(result.values[i]) * result.values[i] + double(eastness.values[i]) * eastness.values[i];
    const double tangent = std::max(least_tangent, std::sqrt(sine2 / std::max(1e-12, 1 - sine2)));
    result.values[i] = static_cast<float>(base::log(area[i] / contour / tangent));
  }
  return result;
}

}  // namespace silvasim::fields
