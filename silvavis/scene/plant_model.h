// A plant model as the tracer holds it: quantised triangles in blocks of eight under a 16-wide tree.
//
// One copy of each number: the tree's leaves are the blocks, and what shading needs of a triangle lies in the order of the
// blocks' slots. Positions are multiples of the model's greatest side / 65535 (0.5 mm for a tree of 32 m); every backend
// decodes the same floats by position_of().
// Made by accel::pack(). Memory: about 45 bytes a triangle, a third of what floats and a library's tree take.
// Source: Silva 2013, section 5 ("we use a regular kd-tree for the tree models").
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "silvavis/assets/model.h"
#include "silvavis/base/vector.h"

namespace silvavis::scene {

inline constexpr int block_size = 8;  // triangles in a leaf
inline constexpr int node_size = 16;  // children of a node
inline constexpr int hull_size = 8;   // cylinders of a hull

// Eight triangles, lane by lane. Empty lanes have three equal corners.
struct TriangleBlock {
  std::array<std::array<std::array<std::uint16_t, block_size>, 3>, 3> corners;  // [corner][axis][lane]
};

// Boxes of up to sixteen children: bound = origin + step * byte. Inner children lie one after another from
// `first_node`, leaves from `first_block`, both in the order of their lanes.
struct TreeNode {
  std::array<std::array<std::uint8_t, node_size>, 3> least{}, most{};  // [axis][child]
  std::array<float, 3> origin{}, step{};
  std::uint32_t first_node = 0;
  std::uint32_t first_block = 0;
  std::uint16_t inner = 0, leaves = 0;  // bit sets of children: which are nodes, which blocks
};

// What is the same for all positions of a turned model: stacked cylinders about the stem that hold every triangle. They
// turn away most rays that would miss the model before its tree is touched.
struct Hull {
  std::array<float, hull_size + 1> edges_m{};  // heights, ascending
  std::array<float, hull_size> radii_m{};
};

struct Slot {
  std::array<std::array<std::uint16_t, 2>, 3> uv{};      // of the corners: uv_origin + uv_step * uv
  std::array<std::array<std::uint8_t, 2>, 3> normals{};  // of the corners, octahedral
  std::uint16_t material = 0;
};

struct PlantModel {
  std::string name;
  V3 origin{0, 0, 0};
  float step_m = 0;
  V2 uv_origin{0, 0}, uv_step{0, 0};
  std::vector<TreeNode> nodes;  // the root first
  std::vector<TriangleBlock> blocks;
  std::vector<Slot> slots;  // block_size a block
  Hull hull;
  float reach_m = 0;  // greatest horizontal distance of a vertex from the stem
  float foot_m = 0;   // the same within the lowest fiftieth: how far the stem's foot reaches out on a slope
  V3 least{0, 0, 0}, most{0, 0, 0};
  std::uint32_t triangles = 0;
  std::vector<assets::Material> materials;
  std::vector<assets::Texture> textures;

  V3 position_of(std::uint32_t slot, int corner) const {
    const auto& c = blocks[slot / block_size].corners[static_cast<std::size_t>(corner)];
    const std::uint32_t lane = slot % block_size;
    return {origin.x + step_m * static_cast<float>(c[0][lane]), origin.y + step_m * static_cast<float>(c[1][lane]),
            origin.z + step_m * static_cast<float>(c[2][lane])};
  }
  V2 uv_of(std::uint32_t slot, int corner) const {
    const auto& at = slots[slot].uv[static_cast<std::size_t>(corner)];
    return {uv_origin.x + uv_step.x * static_cast<float>(at[0]), uv_origin.y + uv_step.y * static_cast<float>(at[1])};
  }
  std::size_t bytes() const {
    std::size_t sum =
        nodes.size() * sizeof(TreeNode) + blocks.size() * sizeof(TriangleBlock) + slots.size() * sizeof(Slot);
    for (const assets::Texture& texture : textures) sum += texture.rgba.size();
    return sum;
  }
};

// Where a ray meets the plane of a triangle: the arithmetic that all backends share, operation by operation, so that they
// agree on what lies a hair's breadth from a hole's rim (Möller and Trumbore 1997).
struct TrianglePoint {
  float t, u, v;
};
TrianglePoint meet_triangle(const PlantModel& model, std::uint32_t slot, const V3& origin, const V3& direction);

// Directions in two bytes by the octahedron (Cigolle et al. 2014); off by at most 1 degree.
std::array<std::uint8_t, 2> packed_normal(const V3& normal);
V3 unpacked_normal(const std::array<std::uint8_t, 2>& packed);

// Whether the surface has a hole at a hit with these barycentric weights of corners 1 and 2: the material's texture is
// more transparent there than its cutoff. The one rule that all backends share.
bool is_hole(const PlantModel& model, std::uint32_t slot, float u, float v);

}  // namespace silvavis::scene
