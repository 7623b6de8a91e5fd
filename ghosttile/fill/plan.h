// What to fill land with: a Ghost Tile, and for each of its objects where it may be, how dense, and which way up.
//
// Units: metres, scene coordinates. The Ghost Tile is laid over space from the scene's zero on: tile (x, y, z) is the
//   cube from (x, y, z) * side; so what lies at a place never depends on how much land is filled.
// Source: Guérin et al. 2016, section 5.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "ghosttile/density/direction.h"
#include "ghosttile/density/field.h"
#include "ghosttile/fill/tile_box.h"
#include "ghosttile/tile/ghost_tile.h"

namespace ghosttile::fill {

using assets::V3;
using assets::V3d;

// Which of the candidates come first (section 5.2, figure 13).
enum class Priority : std::uint8_t {
  random,     // thin layers, scattered things
  elevation,  // the lowest first, above the ground where there is one: piles
  boundary,   // those near the volume's surface first, where the density is least
};

struct ObjectRule {
  density::Field density;
  std::optional<density::Direction> direction;
  // Of scale, where given: candidates of other scales are left out.
  std::optional<density::Field> least_scale, most_scale;
};

struct Plan {
  std::shared_ptr<const tile::GhostTile> tile;
  std::vector<ObjectRule> objects;  // one an object of the tile
  Priority priority = Priority::random;
  std::shared_ptr<const density::Plane> ground;  // heights that elevation is measured from; may be missing
  std::uint64_t seed = 0;
};

// A field may be unbounded: then the box is the largest possible, and must be cut down by who asks.
inline constexpr int farthest_tile = 1 << 28;

// All tiles that may hold something.
TileBox tiles_of(const Plan& plan);
// Those that have a part in the box.
TileBox tiles_within(const Plan& plan, const density::Box3& box);

}  // namespace ghosttile::fill
