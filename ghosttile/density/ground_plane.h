// Planes over rasters: the ground's height, its slope, and any other column of values on a Terrain's grid; and flat ones.
//
// Values: as silvasim::ecosystem::height_at, to the bit, as a float: bilinear between cell centres, the edge's value beyond
//   the edge; a missing value takes no part, and where all around are missing the value is 0.
// Bounds: of a rectangle of a few cells the exact ones; of a larger one those of a cover of at most 5 x 5 blocks of cells.
// Memory: two thirds of the raster's besides the raster. Cost: a sample 1 to 4 ns; a rectangle's bounds below 1 microsecond.
// Threads: immutable. Source: min/max pyramid as in Tevs, Ihrke and Seidel 2008, "Maximum mipmaps".
#pragma once

#include <memory>

#include "ghosttile/density/field.h"
#include "silvasim/ecosystem/ecosystem.h"

namespace ghosttile::density {

using silvasim::ecosystem::Terrain;

// Over a raster that others keep: it must outlive the plane.
std::shared_ptr<const Plane> ground_plane(const Terrain& terrain);
// Over a raster of its own, of any quantity.
std::shared_ptr<const Plane> raster_plane(Terrain raster);
// The ground's slope as rise over run (the tangent of its angle), from central differences at the cell centres.
std::shared_ptr<const Plane> slope_plane(const Terrain& terrain);
std::shared_ptr<const Plane> flat_plane(float value);

// The raster that slope_plane() samples: NaN where the height is.
Terrain slopes_of(const Terrain& terrain);

}  // namespace ghosttile::density
