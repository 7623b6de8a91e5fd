// Features of a vector layer on the scene's frame, cleaned, burnt into a raster.
#pragma once

#include <span>
#include <string>

#include "silvasim/fields/field_set.h"
#include "silvasim/fields/open_vector.h"

namespace silvasim::fields {

struct BurnOptions {
  std::string attribute;     // burn this attribute's number; "": burn 1
  double line_width_m = 0;   // lines become areas of this width; 0: the cells that they touch
  bool all_touched = false;  // every cell that a polygon touches, else those whose centre it holds; lines: touched
};

struct BurnCount {
  long burnt = 0;    // features that reached the raster's neighbourhood
  long skipped = 0;  // without a geometry that can be drawn (null, empty, NaN), or without a number
};

// Burns the features over `raster`, whose grid and first values are given, in the file's order (later ones on top).
//
// A ring that is not closed is closed; a polygon that crosses itself is filled by the even-odd rule, as is a hole
// outside its shell; curves are drawn as lines; long edges follow their own CRS; parts far outside the raster are cut
// off before they are brought to the scene's CRS.
// Errors: base::Error for a damaged file; base::ConfigError for an unknown attribute or one that is no number.
BurnCount burn_features(const VectorFile& file, const config::FieldSettings& field, const Crs& layer_crs,
                        const Crs& scene_crs, const BurnOptions& options, Raster& raster);

}  // namespace silvasim::fields
