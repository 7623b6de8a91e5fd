// The Ghost Tile: a cube of space full of candidates, many more than there is room for, and the graph that tells which of
// them collide, within the tile and with those of the tiles around.
//
// Units: metres, tile space: the tile is [0, side]^3; a candidate's origin lies in it, the rest may stick out.
// Shape: candidates are sorted along a Hilbert curve, so that those that collide have near indices.
// Source: Guérin et al. 2016, section 4; how it is read: docs/ghost-tiles.md.
#pragma once

#include <cstdint>
#include <vector>

#include "ghosttile/objects/detail.h"
#include "ghosttile/tile/collision_graph.h"

namespace ghosttile::tile {

using assets::V3;

// A rotation as a unit quaternion w + xi + yj + zk.
struct Rotation {
  float w = 1, x = 0, y = 0, z = 0;

  V3 operator()(const V3& v) const {
    const V3 q(x, y, z), t = q.cross(v) * 2.0f;
    return v + t * w + q.cross(t);
  }
  V3 z_axis() const { return {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}; }

  friend bool operator==(const Rotation&, const Rotation&) = default;
};

// The paper's frame F: object space to tile space.
struct Candidate {
  std::uint16_t object = 0;  // into GhostTile::objects
  float scale = 1;
  V3 at{0, 0, 0};
  Rotation rotation;

  V3 operator()(const V3& of_object) const { return at + rotation(of_object) * scale; }

  friend bool operator==(const Candidate&, const Candidate&) = default;
};

struct GhostTile {
  float side_m = 0.5f;
  float delta_m =
      0;  // candidates collide where the gap between their spheres is at most this; below 0 they may dip into each other
  std::uint64_t seed = 0;
  std::vector<objects::Detail> objects;
  std::vector<Candidate> candidates;
  CollisionGraph graph;
};

// The farthest that a candidate's spheres or anchors lie from its origin: what sticks out of a tile is within it.
float reach_of(const GhostTile& tile);

}  // namespace ghosttile::tile
