#include "ghosttile/density/ground_plane.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>

#include "ghosttile/density/pyramid.h"
#include "silvasim/base/vector_clones.h"

namespace ghosttile::density {

namespace {

// The four values around a place, and where the place lies between them.
struct Cell {
  int column = 0, row = 0;  // the north-western one
  float north_west = 0, north_east = 0, south_west = 0, south_east = 0;

  bool whole() const { return !(std::isnan(north_west + north_east) || std::isnan(south_west + south_east)); }
};

// As ecosystem::height_at: from cell centre to cell centre, rows from the north.
struct Grid {
  double west = 0, north = 0, cell_width_m = 1, cell_height_m = 1;
  double last_column = 0, last_row = 0;
  int last_cell_column = 0, last_cell_row = 0;
  int columns = 0;
};

inline double clamped(double x, double most) {
  const double up = x > 0 ? x : 0;
  return up < most ? up : most;
}
inline double column_of(const Grid& grid, double x) {
  return clamped((x - grid.west) / grid.cell_width_m - 0.5, grid.last_column);
}
inline double row_of(const Grid& grid, double y) {
  return clamped((grid.north - y) / grid.cell_height_m - 0.5, grid.last_row);
}

// In height_at's order of additions.
inline double between(const Cell& cell, double s, double t) {
  const double a = (1 - s) * (1 - t), b = s * (1 - t), c = (1 - s) * t, d = s * t;
  const double sum = a * static_cast<double>(cell.north_west) + b * static_cast<double>(cell.north_east) +
                     c * static_cast<double>(cell.south_west) + d * static_cast<double>(cell.south_east);
  return sum / (a + b + c + d);
}

double between_known(const Cell& cell, double s, double t) {
  const std::array<double, 4> weights{(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t};
  const std::array<float, 4> values{cell.north_west, cell.north_east, cell.south_west, cell.south_east};
  double sum = 0, weight = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    if (std::isnan(values[k]) || weights[k] <= 0) continue;
    sum += weights[k] * static_cast<double>(values[k]);
    weight += weights[k];
  }
  return weight > 0 ? sum / weight : 0;
}

SILVA_VECTOR_CLONES void grid_places(const Grid& grid, double west, double south, const float* x, const float* y,
                                     std::size_t count, double* __restrict u, double* __restrict v) {
  for (std::size_t i = 0; i < count; ++i) {
    u[i] = column_of(grid, west + static_cast<double>(x[i]));
    v[i] = row_of(grid, south + static_cast<double>(y[i]));
  }
}

// Returns whether all lay in the cell; else the values are of no use.
SILVA_VECTOR_CLONES bool values_in_cell(const Cell& cell, const double* u, const double* v, std::size_t count,
                                        float* __restrict value) {
  const Cell here = cell;
  const double column = here.column, row = here.row;
  std::int64_t outside = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double s = u[i] - column, t = v[i] - row;
    value[i] = static_cast<float>(between(here, s, t));
    outside |= static_cast<std::int64_t>(s < 0) | static_cast<std::int64_t>(s > 1) | static_cast<std::int64_t>(t < 0) |
               static_cast<std::int64_t>(t > 1);
  }
  return outside == 0;
}

// Of a raster without missing values.
SILVA_VECTOR_CLONES void values_in_raster(const Grid& grid, const float* __restrict heights, const double* u,
                                          const double* v, std::size_t count, float* __restrict value) {
  const int last_column = grid.last_cell_column, last_row = grid.last_cell_row, columns = grid.columns;
  const int east = columns > 1 ? 1 : 0, south = grid.last_row > 0 ? columns : 0;
  for (std::size_t i = 0; i < count; ++i) {
    const int u_whole = static_cast<int>(u[i]), v_whole = static_cast<int>(v[i]);
    const int column = u_whole < last_column ? u_whole : last_column, row = v_whole < last_row ? v_whole : last_row;
    const float* at = heights + static_cast<std::ptrdiff_t>(row) * columns + column;
    value[i] =
        static_cast<float>(between({0, 0, at[0], at[east], at[south], at[south + east]}, u[i] - column, v[i] - row));
  }
}

class RasterPlane final : public Plane {
 public:
  explicit RasterPlane(const Terrain& raster) : raster_(&raster) { make(); }
  explicit RasterPlane(Terrain&& raster) : own_(std::move(raster)), raster_(&own_) { make(); }
  RasterPlane(const RasterPlane&) = delete;
  RasterPlane& operator=(const RasterPlane&) = delete;

  void sample(const V3d& origin, const float* x, const float* y, std::size_t count, float* value) const override {
    assert(count <= block_size);
    if (empty_) return void(std::fill_n(value, count, 0.0f));
    if (count == 0) return;
    std::array<double, block_size> u, v;
    grid_places(grid_, origin.x, origin.y, x, y, count, u.data(), v.data());
    // Mostly a whole block lies within one cell.
    const Cell first = cell_at(u[0], v[0]);
    if (first.whole() && values_in_cell(first, u.data(), v.data(), count, value)) return;
    if (!missing_) return values_in_raster(grid_, raster_->heights_m.data(), u.data(), v.data(), count, value);
    for (std::size_t i = 0; i < count; ++i) value[i] = value_at(u[i], v[i]);
  }

  Range bounds(double west, double south, double east, double north) const override {
    if (empty_) return {0, 0};
    const double u_least = column_of(grid_, west), u_most = column_of(grid_, east);
    const double v_least = row_of(grid_, north), v_most = row_of(grid_, south);
    const int first_column = cell_column(u_least), last_column = std::max(cell_column(u_most), first_column);
    const int first_row = cell_row(v_least), last_row = std::max(cell_row(v_most), first_row);
    const int beyond_column = std::min(last_column + 1, raster_->columns - 1),
              beyond_row = std::min(last_row + 1, raster_->rows - 1);
    constexpr int few = 3;
    if (last_column - first_column < few && last_row - first_row < few &&
        !(missing_ && any_missing(first_column, beyond_column, first_row, beyond_row)))
      return exact_bounds(u_least, u_most, v_least, v_most, first_column, last_column, first_row, last_row);
    return pyramid_.range(raster_->heights_m, first_column, first_row, beyond_column, beyond_row);
  }

 private:
  void make() {
    empty_ = raster_->columns <= 0 || raster_->rows <= 0;
    if (empty_) return;
    grid_ = {raster_->west,
             raster_->north,
             raster_->cell_width_m,
             raster_->cell_height_m,
             raster_->columns - 1.0,
             raster_->rows - 1.0,
             std::max(raster_->columns - 2, 0),
             std::max(raster_->rows - 2, 0),
             raster_->columns};
    const auto& values = raster_->heights_m;
    missing_ = std::any_of(values.begin(), values.end(), [](float value) { return std::isnan(value); });
    pyramid_ = Pyramid(values, raster_->columns, raster_->rows);
  }

  int cell_column(double u) const { return std::min(static_cast<int>(u), grid_.last_cell_column); }
  int cell_row(double v) const { return std::min(static_cast<int>(v), grid_.last_cell_row); }

  float height(int column, int row) const {
    return raster_->heights_m[static_cast<std::size_t>(row) * static_cast<std::size_t>(raster_->columns) +
                              static_cast<std::size_t>(column)];
  }

  Cell cell_at(double u, double v) const {
    Cell cell{cell_column(u), cell_row(v)};
    const int east = std::min(cell.column + 1, raster_->columns - 1), south = std::min(cell.row + 1, raster_->rows - 1);
    cell.north_west = height(cell.column, cell.row);
    cell.north_east = height(east, cell.row);
    cell.south_west = height(cell.column, south);
    cell.south_east = height(east, south);
    return cell;
  }

  float value_at(double u, double v) const {
    const Cell cell = cell_at(u, v);
    const double s = u - cell.column, t = v - cell.row;
    return static_cast<float>(cell.whole() ? between(cell, s, t) : between_known(cell, s, t));
  }

  bool any_missing(int first_column, int last_column, int first_row, int last_row) const {
    for (int row = first_row; row <= last_row; ++row)
      for (int column = first_column; column <= last_column; ++column)
        if (std::isnan(height(column, row))) return true;
    return false;
  }

  // What is bilinear takes its least and greatest in corners: of the rectangle, and of the cells that it meets.
  Range exact_bounds(double u_least, double u_most, double v_least, double v_most, int first_column, int last_column,
                     int first_row, int last_row) const {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    Range all{infinity, -infinity};
    for (int j = first_row; j <= last_row + 1; ++j) {
      const double v = std::clamp<double>(j, v_least, v_most);
      for (int i = first_column; i <= last_column + 1; ++i) {
        const float value = value_at(std::clamp<double>(i, u_least, u_most), v);
        all = {std::min(all.least, value), std::max(all.most, value)};
      }
    }
    // Rounding in doubles may lift a float by one step.
    return {std::nextafter(all.least, -infinity), std::nextafter(all.most, infinity)};
  }

  Terrain own_;
  const Terrain* raster_;
  Grid grid_;
  Pyramid pyramid_;
  bool empty_ = false, missing_ = false;
};

class FlatPlane final : public Plane {
 public:
  explicit FlatPlane(float value) : value_(value) {}
  void sample(const V3d&, const float*, const float*, std::size_t count, float* value) const override {
    std::fill_n(value, count, value_);
  }
  Range bounds(double, double, double, double) const override { return {value_, value_}; }

 private:
  float value_;
};

}  // namespace

std::shared_ptr<const Plane> ground_plane(const Terrain& terrain) { return std::make_shared<RasterPlane>(terrain); }

std::shared_ptr<const Plane> raster_plane(Terrain raster) { return std::make_shared<RasterPlane>(std::move(raster)); }

std::shared_ptr<const Plane> flat_plane(float value) { return std::make_shared<FlatPlane>(value); }

std::shared_ptr<const Plane> slope_plane(const Terrain& terrain) { return raster_plane(slopes_of(terrain)); }

Terrain slopes_of(const Terrain& terrain) {
  Terrain slopes = terrain;
  const auto at = [&](int column, int row) {
    return terrain.heights_m[static_cast<std::size_t>(row) * static_cast<std::size_t>(terrain.columns) +
                             static_cast<std::size_t>(column)];
  };
  // Between the neighbours on both sides, or on the one side where the other is beyond the edge or missing.
  const auto rise = [](float before, float here, float after, double cell_m) -> double {
    const bool low = !std::isnan(before), high = !std::isnan(after);
    const double from = static_cast<double>(low ? before : here), to = static_cast<double>(high ? after : here);
    return low || high ? (to - from) / (cell_m * (low + high)) : 0;
  };
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  std::size_t i = 0;
  for (int row = 0; row < terrain.rows; ++row) {
    for (int column = 0; column < terrain.columns; ++column, ++i) {
      const float here = terrain.heights_m[i];
      if (std::isnan(here)) continue;
      const double east = rise(column > 0 ? at(column - 1, row) : none, here,
                               column + 1 < terrain.columns ? at(column + 1, row) : none, terrain.cell_width_m);
      const double south = rise(row > 0 ? at(column, row - 1) : none, here,
                                row + 1 < terrain.rows ? at(column, row + 1) : none, terrain.cell_height_m);
      slopes.heights_m[i] = static_cast<float>(std::sqrt(east * east + south * south));
    }
  }
  return slopes;
}

}  // namespace ghosttile::density
