// One vector layer as a raster on the scene's frame.
#pragma once

#include "silvasim/fields/raster_field.h"

namespace silvasim::fields {

// Square cells of the field's resolution, aligned to the extent's north-western corner.
//
// inside: 1 where a polygon holds the cell's centre, or a line or point touches the cell; 0 elsewhere.
// attribute: the number of the last feature there; NaN where none is.
// distance: metres between cell centres, to the nearest cell that a feature touches, so right to about a cell; features
//   outside the extent count too. Beyond the reach (half the scene's longer side, at least 1 km) it is the reach.
// Errors: base::ConfigError at the field's place (also: nothing near the scene; `where` keeps nothing; too fine a
//   resolution); base::Error for a damaged file.
RasterField load_vector_field(const config::FieldSettings& field, const Frame& frame);

}  // namespace silvasim::fields
