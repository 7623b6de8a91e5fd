#include "silvasim/fields/terrain.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "silvasim/base/error.h"
#include "silvasim/base/parallel.h"
#include "silvasim/fields/arctangent.h"
#include "silvasim/fields/wetness.h"

namespace silvasim::fields {

namespace {

using config::TerrainMeasure;

constexpr float no_value = std::numeric_limits<float>::quiet_NaN();
constexpr double degrees = 180 / pi;

// The heights around a cell, named by where they lie.
struct Window {
  float nw, n, ne, w, c, e, sw, s, se;
};

// A missing neighbour lies on the line through its opposite and the centre, or level with it; a missing diagonal
// one on the plane through the centre and the two between.
void complete(float& a, float& b, float centre) {
  const bool no_a = std::isnan(a), no_b = std::isnan(b);
  if (no_a) a = no_b ? centre : 2 * centre - b;
  if (no_b) b = no_a ? centre : 2 * centre - a;
}

void complete(Window& z) {
  complete(z.n, z.s, z.c);
  complete(z.w, z.e, z.c);
  if (std::isnan(z.nw)) z.nw = z.n + z.w - z.c;
  if (std::isnan(z.ne)) z.ne = z.n + z.e - z.c;
  if (std::isnan(z.sw)) z.sw = z.s + z.w - z.c;
  if (std::isnan(z.se)) z.se = z.s + z.e - z.c;
}

// Uphill per metre to the east and to the north (Horn 1981).
struct Gradient {
  double x, y;
};

// Summed in single precision and in this order, as gdaldem does: on high and flat ground rounding shows, and the two
// should agree there too.
Gradient gradient(const Window& z, double width, double height) {
  const float to_east = (z.ne + z.e + z.e + z.se) - (z.nw + z.w + z.w + z.sw);
  const float to_north = (z.nw + z.n + z.n + z.ne) - (z.sw + z.s + z.s + z.se);
  return {to_east / (8 * width), to_north / (8 * height)};
}

double slope(Gradient g) { return arctangent(std::sqrt(g.x * g.x + g.y * g.y)) * degrees; }

// Clockwise from north, of the way down.
double aspect(Gradient g) {
  if (g.x == 0 && g.y == 0) return no_value;
  const double angle = arctangent(-g.x, -g.y) * degrees;
  return angle < 0 ? angle + 360 : angle;
}

double hillshade(Gradient g) {
  // The sun stands in the north-west, 45 degrees high, as on paper maps.
  const double up = std::sqrt(0.5), across = 0.5;
  const double lit = (up + across * g.x - across * g.y) / std::sqrt(1 + g.x * g.x + g.y * g.y);
  return std::clamp(lit, 0.0, 1.0);
}

double laplacian(const Window& z, double width, double height) {
  const double c = z.c;
  return (z.e - c + (z.w - c)) / (width * width) + (z.n - c + (z.s - c)) / (height * height);
}

double position(const Window& z) {
  float sum = 0;  // single precision for gdaldem's sake again
  int count = 0;
  for (const float value : {z.nw, z.n, z.ne, z.w, z.e, z.sw, z.s, z.se}) {
    if (std::isnan(value)) continue;
    sum += value;
    ++count;
  }
  return count ? z.c - sum / static_cast<float>(count) : no_value;
}

double ruggedness(const Window& z) {
  double sum = 0;
  int count = 0;
  for (const float value : {z.nw, z.n, z.ne, z.w, z.e, z.sw, z.s, z.se}) {
    if (std::isnan(value)) continue;
    sum += (double(value) - z.c) * (double(value) - z.c);
    ++count;
  }
  return count ? std::sqrt(sum * 8 / count) : no_value;
}

double value_of(TerrainMeasure measure, Window z, double width, double height) {
  if (measure == TerrainMeasure::tpi) return position(z);
  if (measure == TerrainMeasure::tri) return ruggedness(z);
  complete(z);
  if (measure == TerrainMeasure::curvature) return laplacian(z, width, height);
  const Gradient g = gradient(z, width, height);
  const double length = std::sqrt(1 + g.x * g.x + g.y * g.y);
  switch (measure) {
    case TerrainMeasure::slope_deg:
      return slope(g);
    case TerrainMeasure::aspect_deg:
      return aspect(g);
    case TerrainMeasure::northness:
      return -g.y / length;
    case TerrainMeasure::eastness:
      return -g.x / length;
    default:
      return hillshade(g);
  }
}

Raster same_grid(const Raster& heights) {
  Raster result = heights;
  std::fill(result.values.begin(), result.values.end(), no_value);
  return result;
}

Raster from_neighbours(TerrainMeasure measure, const Raster& heights) {
  Raster result = same_grid(heights);
  const auto at = [&](int column, int row) {
    const bool inside = column >= 0 && column < heights.columns && row >= 0 && row < heights.rows;
    return inside ? heights.at(column, row) : no_value;
  };
  base::parallel_for(static_cast<std::size_t>(heights.rows), [&](std::size_t line) {
    const int row = static_cast<int>(line);
    float* const out = result.values.data() + line * static_cast<std::size_t>(heights.columns);
    for (int column = 0; column < heights.columns; ++column) {
      const Window z{at(column - 1, row - 1), at(column, row - 1), at(column + 1, row - 1),
                     at(column - 1, row),     at(column, row),     at(column + 1, row),
                     at(column - 1, row + 1), at(column, row + 1), at(column + 1, row + 1)};
      if (!std::isnan(z.c))
        out[column] = static_cast<float>(value_of(measure, z, heights.cell_width, heights.cell_height));
    }
  });
  return result;
}

// Height above the mean of a disc. Each line of the disc is the difference of two running sums.
Raster above_disc(const Raster& heights, double radius_m) {
  Raster result = same_grid(heights);
  const auto columns = static_cast<std::size_t>(heights.columns), rows = static_cast<std::size_t>(heights.rows);
  const int reach = static_cast<int>(std::min(radius_m / heights.cell_height, double(heights.rows)));
  std::vector<int> half_chord;  // of the disc's line so many rows from the middle, in cells
  for (int dy = 0; dy <= reach; ++dy) {
    const double y = dy * heights.cell_height;
    const double cells = std::sqrt(std::max(0.0, radius_m * radius_m - y * y)) / heights.cell_width;
    half_chord.push_back(static_cast<int>(std::min(cells, double(heights.columns))));
  }

  std::vector<double> sums(rows * (columns + 1));
  std::vector<std::int32_t> counts(rows * (columns + 1));
  base::parallel_for(rows, [&](std::size_t row) {
    for (std::size_t column = 0; column < columns; ++column) {
      const std::size_t i = row * (columns + 1) + column;
      const float value = heights.values[row * columns + column];
      sums[i + 1] = sums[i] + (std::isnan(value) ? 0.0 : double(value));
      counts[i + 1] = counts[i] + (std::isnan(value) ? 0 : 1);
    }
  });
  base::parallel_for(rows, [&](std::size_t line) {
    const int row = static_cast<int>(line);
    for (int column = 0; column < heights.columns; ++column) {
      const float centre = heights.at(column, row);
      if (std::isnan(centre)) continue;
      double sum = -double(centre);
      std::int64_t count = -1;
      for (int r = std::max(0, row - reach); r <= std::min(heights.rows - 1, row + reach); ++r) {
        const int chord = half_chord[static_cast<std::size_t>(std::abs(r - row))];
        const std::size_t start = static_cast<std::size_t>(r) * (columns + 1);
        const std::size_t first = start + static_cast<std::size_t>(std::max(0, column - chord));
        const std::size_t last = start + static_cast<std::size_t>(std::min(heights.columns, column + chord + 1));
        sum += sums[last] - sums[first];
        count += counts[last] - counts[first];
      }
      if (count > 0)
        result.values[line * columns + static_cast<std::size_t>(column)] =
            static_cast<float>(centre - sum / double(count));
    }
  });
  return result;
}

}  // namespace

Raster derive(TerrainMeasure measure, const Raster& heights, double radius_m) {
  if (measure == TerrainMeasure::wetness) return wetness_index(heights);
  const bool disc = measure == TerrainMeasure::tpi && radius_m >= std::min(heights.cell_width, heights.cell_height);
  return disc ? above_disc(heights, radius_m) : from_neighbours(measure, heights);
}

double needed_margin_m(TerrainMeasure measure, double radius_m, double longer_side_m) {
  if (measure == TerrainMeasure::tpi) return radius_m;
  if (measure == TerrainMeasure::wetness) return longer_side_m / 4;
  return 0;
}

}  // namespace silvasim::fields
