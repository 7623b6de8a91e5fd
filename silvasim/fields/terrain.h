// Measures derived from a raster of heights.
#pragma once

#include "silvasim/config/field_settings.h"
#include "silvasim/fields/raster.h"

namespace silvasim::fields {

// The measure on the same grid. Units and signs as config::TerrainMeasure says.
//
// Slope and aspect use Horn's (1981) weights, curvature Zevenbergen and Thorne's (1987) centre differences, tri
// Riley's (1999) root of the summed squares, as gdaldem does by default. With tpi, `radius_m` > 0 asks for the mean
// of the cells whose centres lie in the disc, without the middle one.
//
// No data: where the cell has none. A missing neighbour (beyond the grid, or no data) is put on the line through its
//   opposite and the cell, a diagonal one on the plane through those beside it, so that a plane keeps its slope up to
//   its rim. In tpi and tri it is left out (tri is scaled to eight neighbours).
// Promise: the same bytes on every machine and for any number of threads; only + - * / and square roots are used.
//   Slope, aspect, tpi and tri agree with gdaldem's (3.6) to the last digits of a float.
// Threads: runs in parallel inside.
// Cost: about 10 ns a cell; tpi with a radius 2 ns a cell and line of the disc; wetness 0.3 microseconds a cell.
Raster derive(config::TerrainMeasure measure, const Raster& heights, double radius_m = 0);

// How far around the scene the heights should be known for this measure, in metres: flow comes from far.
double needed_margin_m(config::TerrainMeasure measure, double radius_m, double longer_side_m);

}  // namespace silvasim::fields
