#include <algorithm>
#include <cassert>
#include <cmath>

#include "silvasim/fields/raster.h"

namespace silvasim::fields {

namespace {

// Positions closer to a cell centre (or to the grid's rim) than this are on it: a millionth of a cell, so that the
// rounding of large coordinates does not mix a neighbour in.
constexpr double snap_cells = 1e-6;

// Inside the grid's extent, in cells from its north-western corner? Then clamped to it.
bool place(double& column, double& row, double columns, double rows) {
  const bool inside =
      column >= -snap_cells && column <= columns + snap_cells && row >= -snap_cells && row <= rows + snap_cells;
  column = inside ? column : 0;
  row = inside ? row : 0;
  return inside;
}

// From a position in cells to the centre before it and the fraction, below 1, of the way to the next.
void between_centres(double position, double last, std::int32_t& lower, float& fraction) {
  const double centred = std::min(std::max(position - 0.5, 0.0), last);
  lower = static_cast<std::int32_t>(centred + snap_cells);
  const double f = centred - lower;
  fraction = f < snap_cells ? 0.0f : static_cast<float>(f);
}

// Exact at the first end and where both are equal, which a site on a plateau's rim relies on.
float blend(float from, float to, float fraction) { return from + fraction * (to - from); }

// Some of the four are missing: share out their weights, unless the nearest one is missing.
bool mend(const float (&value)[4], float u, float v, float& result) {
  const float weight[4] = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
  const int nearest = (u >= 0.5f ? 1 : 0) + (v >= 0.5f ? 2 : 0);
  if (!std::isfinite(value[nearest])) return false;
  double sum = 0, total = 0;
  for (int k = 0; k < 4; ++k) {
    if (!std::isfinite(value[k]) || weight[k] == 0) continue;
    sum += double(value[k]) * weight[k];
    total += weight[k];
  }
  result = static_cast<float>(sum / total);
  return true;
}

}  // namespace

void sample(const Raster& raster, config::FieldKind kind, std::span<const double> x, std::span<const double> y,
            std::span<float> value, std::span<std::uint8_t> no_data) {
  assert(x.size() == y.size() && x.size() == value.size() && x.size() == no_data.size());
  const double columns = raster.columns, rows = raster.rows, west = raster.west, north = raster.north;
  const double across = 1 / raster.cell_width, along = 1 / raster.cell_height;  // cells a metre
  const auto width = static_cast<std::size_t>(raster.columns);
  const float* const cells = raster.values.data();
  if (raster.columns <= 0 || raster.rows <= 0) {
    std::fill(value.begin(), value.end(), 0.0f);
    std::fill(no_data.begin(), no_data.end(), std::uint8_t{1});
    return;
  }

  if (kind == config::FieldKind::class_code) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      double column = (x[i] - west) * across, row = (north - y[i]) * along;
      const bool inside = place(column, row, columns, rows);
      const auto c = static_cast<std::size_t>(std::min(std::max(column, 0.0), columns - 1));
      const auto r = static_cast<std::size_t>(std::min(std::max(row, 0.0), rows - 1));
      const float code = cells[r * width + c];
      const bool known = inside && std::isfinite(code);
      value[i] = known ? code : 0;
      no_data[i] = !known;
    }
    return;
  }

  for (std::size_t i = 0; i < x.size(); ++i) {
    double column = (x[i] - west) * across, row = (north - y[i]) * along;
    const bool inside = place(column, row, columns, rows);
    std::int32_t c = 0, r = 0;
    float u = 0, v = 0;
    between_centres(column, columns - 1, c, u);
    between_centres(row, rows - 1, r, v);
    const std::size_t right = c + 1 < raster.columns ? 1 : 0, down = r + 1 < raster.rows ? width : 0;
    const float* const four = cells + static_cast<std::size_t>(r) * width + static_cast<std::size_t>(c);
    const float values[4] = {four[0], four[right], four[down], four[down + right]};
    float result = blend(blend(values[0], values[1], u), blend(values[2], values[3], u), v);
    bool known = inside;
    if (!std::isfinite(result)) known = mend(values, u, v, result) && inside;
    value[i] = known ? result : 0;
    no_data[i] = !known;
  }
}

}  // namespace silvasim::fields
