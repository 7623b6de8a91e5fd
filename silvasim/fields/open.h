// Opens a user's file as a raster or as vectors, within limits, and says where it lies on the earth.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "silvasim/config/field_settings.h"
#include "silvasim/fields/crs.h"

class GDALDataset;

namespace silvasim::fields {

struct CloseDataset {
  void operator()(GDALDataset* dataset) const;
};
using Dataset = std::unique_ptr<GDALDataset, CloseDataset>;

// Opens the file of a raster field, read-only.
//
// Errors: base::ConfigError at the field's place: no such file, no format that Silva reads, no such band, complex
//   numbers, a claim that cannot be true (many more cells than the file has bytes, blocks of gigabytes).
// Threads: a dataset belongs to the thread that opened it.
Dataset open_raster(const config::FieldSettings& field);

// How the cells of a raster lie. Pixel coordinates: (0, 0) is the outer corner of the first cell.
struct Georeference {
  bool placed = false;  // false: an image without georeference, to be stretched over the scene
  std::array<double, 6> transform{0, 1, 0,
                                  0, 0, 1};  // as GDAL's: x = t0 + column t1 + row t2, y = t3 + column t4 + row t5
  Crs crs;                                   // empty: in the scene's own coordinates
  bool crs_known = false;                    // false with placed: neither the file nor the user names a CRS
  int columns = 0, rows = 0;

  bool axis_parallel() const { return transform[2] == 0 && transform[4] == 0; }
  base::Point at(double column, double row) const {
    return {transform[0] + column * transform[1] + row * transform[2],
            transform[3] + column * transform[4] + row * transform[5]};
  }
};

// Errors: base::ConfigError at the field's place for a transform that cannot be, and for a CRS that nobody knows.
Georeference georeference_of(GDALDataset& dataset, const config::FieldSettings& field);

// The box around the raster in its own CRS.
base::Box own_extent(const Georeference& georeference);

// Throws the ConfigError that every message about a field is made of: `data field "dem": message`.
[[noreturn]] void fail_at(const config::FieldSettings& field, const std::string& message);

// What a field's settings say, for GDAL; what cannot be is a ConfigError at the field's place.
std::string name_for_gdal(const config::FieldSettings& field);  // of the file, contained (containment.h)
Crs crs_of_user(const config::FieldSettings& field);            // of FieldSettings::crs, which is not empty

}  // namespace silvasim::fields
