// A raster on the scene's frame, and how a value is read from it between its cells.
//
// Shape: `columns` x `rows` cells, row by row, row 0 northernmost. Values sit at cell centres.
// No data: NaN.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "silvasim/base/geometry.h"
#include "silvasim/config/field_settings.h"

namespace silvasim::fields {

struct Raster {
  int columns = 0;
  int rows = 0;
  double west = 0;         // scene x of the grid's west edge (not of the first centre)
  double north = 0;        // scene y of the grid's north edge
  double cell_width = 1;   // metres, > 0
  double cell_height = 1;  // metres, > 0
  std::vector<float> values;

  float at(int column, int row) const {
    return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
  }
  base::Box extent() const { return {west, north - rows * cell_height, west + columns * cell_width, north}; }

  friend bool operator==(const Raster&, const Raster&) = default;
};

// Reads the raster at scene points, in one loop without calls.
//
// A point outside the grid's extent has no data. Between the outermost centres and the edge the edge's value holds.
// Where one of the four cells around a point is NaN, the others' weights are scaled up, unless the nearest cell itself
// is NaN.
//
// no_data[i] = 1 and value[i] = 0 where there is no data, else 0 and the value, which is finite.
void sample(const Raster& raster, config::FieldKind kind, std::span<const double> x, std::span<const double> y,
            std::span<float> value, std::span<std::uint8_t> no_data);

}  // namespace silvasim::fields
