// From a file's pixels to the scene and back, and the resampling between the two, by GDAL's warper.
#pragma once

#include <vector>

#include "silvasim/config/field_settings.h"
#include "silvasim/fields/open.h"
#include "silvasim/fields/raster.h"

namespace silvasim::fields {

struct PixelBounds {
  bool any = false;  // false: no point of the window has an image in the file's CRS
  double least_column = 0, most_column = 0, least_row = 0, most_row = 0;
};

struct CellSize {
  double width = 0, height = 0;  // of a file's cell along the scene's axes, metres
};

// Scene points as pixel coordinates of a file.
class PixelMap {
 public:
  PixelMap(const Georeference& grid, const Crs& scene_crs);

  void apply(std::vector<double>& x, std::vector<double>& y) const;  // in place; NaN where there is no image
  PixelBounds bounds(const base::Box& window) const;                 // of the window's image, inside and rim
  CellSize cell_size(const base::Box& window) const;                 // about the middle of what window and file share

 private:
  Georeference grid_;
  Transformation to_file_;
};

// True if a point of the scene has the same coordinates in the file's CRS, to a ten-thousandth of a cell: equal
// systems, and such that differ by name or realisation only.
bool lies_alike(const Georeference& grid, const Crs& scene_crs);

// Fills raster.values (its grid is given) from cells that lie as `grid` says. Values bilinear, weights of missing
// neighbours shared out; classes nearest; NaN where there is none.
// Promise: same bytes on the same machine and libraries; PROJ's sines may differ in the last bits on another.
void warp(std::vector<float>& cells, const Georeference& grid, config::FieldKind kind, const Crs& scene_crs,
          Raster& raster);

}  // namespace silvasim::fields
