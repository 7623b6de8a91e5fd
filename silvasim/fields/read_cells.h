// Cells of a raster file as floats with one meaning of "no data": NaN.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "silvasim/config/field_settings.h"

class GDALDataset;

namespace silvasim::fields {

// A rectangle of cells, in pixel coordinates of the file.
struct CellWindow {
  int column = 0, row = 0, columns = 0, rows = 0;

  bool empty() const { return columns <= 0 || rows <= 0; }
  double cells() const { return double(columns) * rows; }
};

// How a stored number becomes a value.
enum class Decoding {
  as_stored,  // raw * scale + offset: the file's (not for classes, nor for raw images), then the user's
  grey,       // an image without georeference: 0..1 whatever its depth; a palette by its colours' brightness
};

struct Cells {
  int columns = 0, rows = 0;
  std::vector<float> values;
  std::string note;  // for people: "feet turned into metres"; may be empty
};

// Reads the window of the field's band. With `block` > 1 the result holds one cell for each block of so many cells
// squared, their mean (value) or the commonest code (class), so that memory stays bounded by the result.
//
// No data: the file's nodata value, the user's, NaN, infinities, what does not fit a float, cells that a mask or an
//   alpha band hides; in a terrain -9999, -32767 and -32768, which no ground has and careless files do not declare.
// Errors: base::Error if the file cannot be read there; base::ConfigError for class codes past 2^24 (inexact).
Cells read_cells(GDALDataset& dataset, const config::FieldSettings& field, Decoding decoding, const CellWindow& window,
                 int block = 1);

}  // namespace silvasim::fields
