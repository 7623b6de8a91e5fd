// Instances one by one, worked out from the tile that they stand in: for exports and statistics.
#pragma once

#include "ghosttile/fill/details.h"
#include "ghosttile/tile/ghost_tile.h"

namespace ghosttile::fill {

struct Instance {
  std::uint16_t object = 0;  // into GhostTile::objects
  std::uint16_t candidate = 0;
  TilePlace tile;
  assets::V3d at{0, 0, 0};  // of the object's origin, scene coordinates
  float scale = 1;
  tile::Rotation rotation;  // object to scene
};

// Calls visit(Instance) for all, tile by tile in the order of Details.
template <typename Visit>
void for_each_instance(const tile::GhostTile& tile, const Details& details, Visit&& visit) {
  const auto side = static_cast<double>(tile.side_m);
  for (std::size_t t = 0; t < details.tiles.size(); ++t) {
    const TilePlace& place = details.tiles[t];
    for (const std::uint16_t c : details.of(t)) {
      const tile::Candidate& candidate = tile.candidates[c];
      Instance instance;
      instance.object = candidate.object;
      instance.candidate = c;
      instance.tile = place;
      instance.at = {place.x * side + static_cast<double>(candidate.at.x),
                     place.y * side + static_cast<double>(candidate.at.y),
                     place.z * side + static_cast<double>(candidate.at.z)};
      instance.scale = candidate.scale;
      instance.rotation = candidate.rotation;
      visit(static_cast<const Instance&>(instance));
    }
  }
}

}  // namespace ghosttile::fill
