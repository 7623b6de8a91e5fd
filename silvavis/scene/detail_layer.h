// Ground detail as the renderer holds it: the candidates of one Ghost Tile, and which of them stand in which tile.
//
// Shape: a tree of 4 x 4 over columns of tiles that exists only where something stands; in a tile groups of sixteen instances with
//   a box each, then the candidates' own boxes, then the object's model by the candidate's frame. An instance is two bytes and its share of
//   a group's box; all that can be asked of it is its candidate's.
// Units: metres. Tile (x, y, z) is the cube from (x, y, z) * side in scene coordinates; world space is the scene's.
// Memory: 2.4 bytes an instance, 16 a tile, 17 a column of tiles: 2.7 of all that an instance where 120 share a tile, 3.5 where 30 do.
// Source: Guérin et al. 2016, section 3 (instances as lists of indexes).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "silvavis/base/vector.h"
#include "silvavis/scene/plant_model.h"

namespace silvavis::scene {

inline constexpr std::uint32_t detail_group = 16;  // instances that share a box

// A candidate: how its object lies in the tile. v -> at + rotation(v) * scale, rotation the unit quaternion w + xi + yj + zk.
struct DetailFrame {
  V3 at{0, 0, 0};
  float scale = 1;
  float w = 1, x = 0, y = 0, z = 0;
  std::uint32_t model = 0;   // into Scene::models
  std::uint16_t object = 0;  // into DetailLayer::objects
  float size_m = 0;          // how wide it looks: the root of the area that it covers, mean over all sides

  V3 turned(const V3& v) const {
    const V3 q(x, y, z), t = q.cross(v) * 2.0f;
    return v + t * w + q.cross(t);
  }
  V3 turned_back(const V3& v) const {
    const V3 q(-x, -y, -z), t = q.cross(v) * 2.0f;
    return v + t * w + q.cross(t);
  }
};

// Of 4 x 4 children [y * 4 + x]: nodes of the level below, or columns of tiles on level 0. Those that are there lie one after another
// from `first`, in the order of their bits.
struct DetailNode {
  std::array<float, 16> least_m{}, most_m{};  // heights of what stands there
  std::uint32_t first = 0;
  std::uint16_t children = 0;
};

// A column of tiles above one another, up to the next one's first tile.
struct DetailColumn {
  std::uint32_t first_tile = 0;
  std::uint8_t depth =
      0;  // area that its instances cover seen from above, each by itself, over the column's; in detail_depth_step
  std::array<std::uint8_t, 3> colour{};  // of what covers it: the root of the reflectance, of 255
};
inline constexpr float detail_depth_step = 1.0f / 64;

struct DetailTile {
  std::int32_t z = 0;
  std::uint32_t first = 0;  // into DetailLayer::chosen, up to the next tile's
  std::uint32_t first_group = 0;
  std::uint32_t number = 0;  // of its first instance among all, in the order of Details
};

struct DetailLayer {
  std::string name;  // of the file, or what it was filled from
  double side_m = 1;
  std::int32_t first_x = 0, first_y = 0;  // tile at the tree's south-western corner
  V3d corner{0, 0, 0};                    // of that tile, at height 0, in world space

  std::vector<std::string> objects;  // names
  std::vector<DetailFrame> frames;   // by candidate
  // Boxes by candidate, in tile space: [axis].
  std::array<std::vector<float>, 3> least_m, most_m;
  float margin_m = 0;  // how far instances reach out of their tile, at most

  int levels = 1;
  std::vector<DetailNode> nodes;      // the root first
  std::vector<DetailColumn> columns;  // and one more
  std::vector<DetailTile> tiles;      // and one more
  std::vector<std::uint16_t>
      chosen;  // candidates, tile by tile; and detail_group more, so that whole groups can be read
  // Boxes of groups, as bytes: tile by tile [axis][least, most][group], and 16 more; bound = group_origin_m + group_step_m * byte.
  std::vector<std::uint8_t> group_bounds;
  float group_origin_m = 0, group_step_m = 1;
  V3d least{0, 0, 0}, most{0, 0, 0};  // of all, world space

  std::uint32_t first_object =
      0;  // among the species of all layers and the objects of all details: numbers for pictures
  std::uint64_t first_plant = 0;  // likewise among all sites and instances

  // Instances that are smaller than half a pixel are left out, and the ground beneath takes their colour (detail_cover()).
  bool fades = false;
  float most_size_m = 0;          // of DetailFrame::size_m, of those that stand
  float depth_scale = 1;          // cover = 1 - exp(-depth * depth_scale)
  Rgb tint{1, 1, 1};              // what a column's colour is multiplied with, since what stands close shades itself
  float gap_light = 1;            // of the light that comes to the ground between them
  std::vector<float> part_faded;  // by width in even steps up to most_faded(): share of the cover that is left out

  std::uint64_t count() const { return chosen.size() < detail_group ? 0 : chosen.size() - detail_group; }
  std::uint64_t instances_bytes() const;                        // all that grows with their number
  float most_faded() const { return 2 * 1.25f * most_size_m; }  // width of rays that meet none
};

// The candidate's own, so that neighbours are left out at different distances.
inline float detail_dither(std::int32_t x, std::int32_t y, std::int32_t z, std::uint32_t candidate) {
  std::uint64_t h = static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32 | static_cast<std::uint32_t>(y);
  h = (h * 0x9E3779B97F4A7C15u ^ static_cast<std::uint32_t>(z)) * 0xD6E8FEB86659FD93u + candidate;
  h = (h ^ (h >> 32)) * 0xD6E8FEB86659FD93u;
  return static_cast<float>(h >> 56) * (1.0f / 256);
}
// Whether a ray of this width passes through it.
inline bool is_faded(const DetailFrame& frame, float dither, float width_m) {
  return width_m > 2 * frame.size_m * (0.75f + 0.5f * dither);
}
inline std::uint8_t detail_level(const PlantModel& model, const DetailFrame& frame, float dither, float width_m) {
  const float wide = width_m / (frame.scale * (0.75f + 0.5f * dither));
  std::uint8_t level = 0;
  while (level < model.coarser.size() && model.coarser[level]->leaf_m <= wide) ++level;
  return level;
}

// The number of the instance at that place of `chosen` among all, in the order of Details: by y, x, z of the tile.
std::uint32_t detail_number(const DetailLayer& layer, std::uint32_t slot);

// What the ground below details that are left out looks like.
struct DetailCover {
  float share = 0;  // of the ground that they hide
  Rgb colour{0, 0, 0};
  float gap_light = 1;  // of the light on the rest
};
// At a point of the ground, world space, for a ray of that width.
DetailCover detail_cover(const DetailLayer& layer, const V3d& at, float width_m);

}  // namespace silvavis::scene
