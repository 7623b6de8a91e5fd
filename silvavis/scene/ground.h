// The land's surface: two triangles a cell between heights on a regular grid, and least and greatest heights in a
// pyramid above them.
//
// Units: metres, world space. The grid reaches half a cell beyond the terrain's outermost centres, where the edge's
// heights hold, so that it covers the terrain's cells. No data is filled from its neighbours. Column i, row j of the
// vertices lies at (west + i * cell_x, south + j * cell_y): row 0 is the southernmost. Each cell is cut from its south-west to
// its north-east corner.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "silvasim/base/geometry.h"
#include "silvasim/ecosystem/ecosystem.h"
#include "silvavis/base/vector.h"
#include "silvavis/scene/pyramid.h"

namespace silvavis::scene {

struct Ground {
  int columns = 0, rows = 0;  // of vertices; cells are one less
  double west = 0, south = 0;
  double cell_x_m = 1, cell_y_m = 1;
  std::vector<float> heights_m;
  Pyramid pyramid;  // over cells

  float at(int column, int row) const {
    return heights_m[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                     static_cast<std::size_t>(column)];
  }
  double east() const { return west + (columns - 1) * cell_x_m; }
  double north() const { return south + (rows - 1) * cell_y_m; }
};

// `origin`: the scene point that becomes world (0, 0). Without a terrain: flat land at height 0 under `extent`.
// Errors: base::Error for heights beyond 100 km, which are numbers that stand for no data.
Ground make_ground(const silvasim::ecosystem::Terrain& terrain, const silvasim::base::Box& extent,
                   silvasim::base::Point origin);

struct GroundPoint {
  double height_m = 0;
  double slope_x = 0, slope_y = 0;  // of the triangle: metres up a metre
};
// Beyond the edge: as at the nearest point of the grid.
GroundPoint ground_at(const Ground& ground, double x, double y);

// Smooth up-direction for shading, from central differences between vertices, bilinear.
V3 ground_normal(const Ground& ground, double x, double y);

}  // namespace silvavis::scene
