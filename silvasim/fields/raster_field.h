// One raster file brought onto the scene's frame.
#pragma once

#include <string>

#include "silvasim/config/field_settings.h"
#include "silvasim/fields/field_set.h"

namespace silvasim::fields {

struct RasterField {
  Raster raster;
  std::string source;  // one line for reports
};

// Reads the part of the file that covers the frame's extent and `margin_m` around it.
//
// In the scene's own CRS with axis-parallel cells (north or south up), the grid is cut, not resampled: a cell centre
// returns the cell. Otherwise it is warped to a grid of about its own resolution at the scene's middle, values
// bilinear, classes nearest. An image without georeference is stretched over the extent. More than most_field_cells in
// the window: neighbouring cells are merged first (mean or commonest).
//
// Errors: base::ConfigError at the field's place, base::Error while reading.
RasterField load_raster_field(const config::FieldSettings& field, const Frame& frame, double margin_m);

constexpr double most_field_cells = 100e6;

}  // namespace silvasim::fields
