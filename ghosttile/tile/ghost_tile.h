// The Ghost Tile: a cube of space full of candidates, many more than there is room for, and the graph that tells which of
// them collide, within the tile and with the same candidates of the tiles around.
//
// Units: metres, tile space: the tile is [0, side]^3; a candidate's origin lies in it, the rest may stick out.
// Shape: candidates are sorted along a Hilbert curve, so that those that collide have near indices.
// Source: Guérin et al. 2016, section 4; how it is read: docs/reading.md, E1 to E3.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "ghosttile/objects/detail.h"
#include "ghosttile/tile/collision_graph.h"

namespace ghosttile::tile {

using assets::V3;

// A rotation as a unit quaternion w + xi + yj + zk.
struct Rotation {
  float w = 1, x = 0, y = 0, z = 0;

  V3 operator()(const V3& v) const;
  V3 z_axis() const { return {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}; }
};

// The paper's frame F: object space to tile space.
struct Candidate {
  std::uint16_t object = 0;  // into GhostTile::objects
  float scale = 1;
  V3 at{0, 0, 0};
  Rotation rotation;

  V3 operator()(const V3& of_object) const { return at + rotation(of_object) * scale; }
};

struct GhostTile {
  double side_m = 0.5;
  float delta_m = 0;  // interpenetration threshold: two candidates collide where their spheres are no farther apart
  std::uint64_t seed = 0;
  std::vector<objects::Detail> objects;
  std::vector<Candidate> candidates;
  CollisionGraph graph;
};

}  // namespace ghosttile::tile
