// The topographic wetness index, and the flow of water that it is made of.
#pragma once

#include <vector>

#include "silvasim/fields/raster.h"

namespace silvasim::fields {

// ln(a / tan(slope)): a is the ground that drains through a metre of the cell's contour, in metres, with the cell
// itself; the slope Horn's, at least 0.001, so that flats are wet and finite.
//
// No data: where the heights have none. Water leaves over the grid's rim and into cells without data, so near the rim
//   the index is too low where more ground would lie uphill beyond it.
// Promise: the same bytes on every machine. Source: Beven and Kirkby 1979.
Raster wetness_index(const Raster& heights);

// The area that drains through each cell, in square metres, with the cell's own; 0 where there is no data.
//
// Depressions are filled by a priority flood (Barnes, Lehman and Mulla 2014). Water then runs to all lower neighbours,
// in proportion to the slope towards them times the length of contour that faces them (Quinn et al. 1991); on a flat it
// runs the way by which the flood came, which leads to its outlet. What leaves over the rim is what fell.
std::vector<double> catchment_area_m2(const Raster& heights);

// The heights with every depression filled to its lowest outlet.
std::vector<float> filled_heights(const Raster& heights);

}  // namespace silvasim::fields
