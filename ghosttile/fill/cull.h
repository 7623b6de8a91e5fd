// Culling within a tile: the densities at the anchors of its candidates, their directions and scales.
#pragma once

#include <cstdint>
#include <vector>

#include "ghosttile/fill/plan.h"

namespace ghosttile::fill {

// An object's candidates as columns, in tile space.
struct ObjectColumns {
  std::vector<std::uint16_t> candidates;
  std::size_t anchors = 1;              // a candidate
  std::vector<float> x, y, z;           // of the anchors, candidate by candidate
  std::vector<float> at_x, at_y, at_z;  // of the origins
  std::vector<V3> z_axis;
  std::vector<float> scale;
};
std::vector<ObjectColumns> object_columns(const tile::GhostTile& tile);

struct CullScratch {
  density::Scratch fields;
  std::vector<float> x, y, z, value;
  std::vector<V3> directions;
};

// Least and greatest density at the anchors of each of the object's candidates, in a tile that begins at `offset` from the
// corner that `density` was compiled for.
void densities_at(const ObjectColumns& columns, const density::Compiled& density, const V3& offset,
                  CullScratch& scratch, float* least, float* most);
// A field at the origins of the object's candidates.
void values_at_origins(const ObjectColumns& columns, const density::Compiled& field, const V3& offset,
                       CullScratch& scratch, float* value);
// The cosine between each candidate's z-axis and the direction at its origin; -2 where there is no direction.
void cosines_at(const ObjectColumns& columns, const density::Direction& direction, const density::Compiled& density,
                const V3d& corner, const V3& offset, CullScratch& scratch, float* cosine);

}  // namespace ghosttile::fill
