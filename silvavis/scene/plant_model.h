// A plant model as the tracer holds it: quantised triangles in blocks of eight under a 16-wide tree.
//
// One copy of each number: the tree's leaves are the blocks, and what shading needs of a triangle lies in the order of the
// blocks' slots. Positions are multiples of the model's greatest side / 65535 (0.5 mm for a tree of 32 m); every backend
// decodes the same floats by position_of().
// Made by accel::pack(). Memory: about 45 bytes a triangle, a third of what floats and a library's tree take.
// Source: Silva 2013, section 5 ("we use a regular kd-tree for the tree models").
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "assets/model.h"
#include "silvasim/base/huge_vector.h"
#include "silvavis/base/vector.h"
#include "silvavis/scene/impostor.h"

namespace silvavis::scene {

inline constexpr int block_size = 8;   // triangles in a leaf
inline constexpr int node_size = 16;   // children of a node
inline constexpr int most_depth = 32;  // levels of a model's tree; the walk's stack has room for them
inline constexpr int hull_size = 8;    // cylinders of a hull

// Eight triangles, lane by lane, with all that tells whether a ray meets them: four lines of a cache side by side. Empty lanes
// have three equal corners.
struct alignas(64) TriangleBlock {
  std::array<std::array<std::array<std::uint16_t, block_size>, 3>, 3> corners;  // [corner][axis][lane]
  std::array<std::array<std::array<std::uint16_t, block_size>, 2>, 3>
      uv;  // [corner][axis][lane]: uv_origin + uv_step * uv
  std::array<std::uint16_t, block_size> materials;
};
static_assert(sizeof(TriangleBlock) == 256);

// Boxes of up to sixteen children: bound = origin + step * byte, each step a power of two. Inner children lie one after
// another from `first_node`, leaves from `first_block`, both in the order of their lanes. Two lines of a cache.
struct alignas(64) TreeNode {
  std::array<std::array<std::uint8_t, node_size>, 3> least{}, most{};  // [axis][child]
  std::array<float, 3> origin{};
  std::array<std::uint8_t, 3> exponent{};  // of the steps, as in a float: step = 2^(exponent - 127)
  std::uint32_t first_node = 0;
  std::uint32_t first_block = 0;
  std::uint16_t inner = 0, leaves = 0;  // bit sets of children: which are nodes, which blocks

  float step(std::size_t axis) const { return std::bit_cast<float>(std::uint32_t{exponent[axis]} << 23); }
};
static_assert(sizeof(TreeNode) == 128);

// What is the same for all positions of a turned model: stacked cylinders about the stem that hold every triangle. They
// turn away most rays that would miss the model before its tree is touched.
struct Hull {
  std::array<float, hull_size + 1> edges_m{};  // heights, ascending
  std::array<float, hull_size> radii_m{};
};

// What only shading needs of a triangle: its corners' normals, octahedral.
using SlotNormals = std::array<std::array<std::uint8_t, 2>, 3>;

// Where a material is a hole, as bits: its texture, twice as fine, cut at the material's cutoff. One bit instead of four
// texels a question keeps the answer in the nearest cache.
struct Cutout {
  std::uint32_t width = 0, height = 0;  // 0: no holes
  std::vector<std::uint64_t> holes;     // row by row, width / 64 words each
  bool two_sided = true;                // the material's
};

// What a model and its simpler levels share.
struct Looks {
  std::vector<assets::Material> materials;
  std::vector<Cutout> cutouts;  // one a material
  std::vector<assets::Texture> textures;

  std::size_t bytes() const;
};
std::shared_ptr<const Looks> looks_of(const assets::Model& model);

struct PlantModel {
  std::string name;
  V3 origin{0, 0, 0};
  float step_m = 0;
  V2 uv_origin{0, 0}, uv_step{0, 0};
  std::vector<TreeNode> nodes;  // the root first
  silvasim::base::HugeVector<TriangleBlock> blocks;
  std::vector<SlotNormals> normals;  // by slot: block_size a block
  Hull hull;
  float reach_m = 0;  // greatest horizontal distance of a vertex from the stem
  float foot_m = 0;   // the same within the lowest fiftieth: how far the stem's foot reaches out on a slope
  V3 least{0, 0, 0}, most{0, 0, 0};
  std::uint32_t triangles = 0;
  std::shared_ptr<const Looks> looks;

  // Simpler ones, for where a pixel is wider than their leaves; each simpler than the one before (levels/thin.h).
  std::vector<std::shared_ptr<const PlantModel>> coarser;
  std::shared_ptr<const Impostor> impostor;  // for where a pixel is as wide as its texels; may be missing
  float leaf_m = 0;                          // side of a typical leaf
  float tint = 1;                            // what its colours are multiplied with, to be as bright as the full model

  V3 position_of(std::uint32_t slot, int corner) const {
    const auto& c = blocks[slot / block_size].corners[static_cast<std::size_t>(corner)];
    const std::uint32_t lane = slot % block_size;
    return {origin.x + step_m * static_cast<float>(c[0][lane]), origin.y + step_m * static_cast<float>(c[1][lane]),
            origin.z + step_m * static_cast<float>(c[2][lane])};
  }
  V2 uv_of(std::uint32_t slot, int corner) const {
    const auto& at = blocks[slot / block_size].uv[static_cast<std::size_t>(corner)];
    const std::uint32_t lane = slot % block_size;
    return {uv_origin.x + uv_step.x * static_cast<float>(at[0][lane]),
            uv_origin.y + uv_step.y * static_cast<float>(at[1][lane])};
  }
  std::uint16_t material_of(std::uint32_t slot) const { return blocks[slot / block_size].materials[slot % block_size]; }
  std::size_t bytes() const {
    std::size_t sum =
        nodes.size() * sizeof(TreeNode) + blocks.size() * sizeof(TriangleBlock) + normals.size() * sizeof(SlotNormals);
    for (const auto& level : coarser) sum += level->bytes();
    if (impostor) sum += impostor->bytes();
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

// Whether the surface has a hole at a hit with these weights of corners 1 and 2. The one rule that all backends share.
inline bool is_hole(const PlantModel& model, std::uint32_t slot, float u, float v) {
  const TriangleBlock& block = model.blocks[slot / block_size];
  const std::uint32_t lane = slot % block_size;
  const Cutout& cutout = model.looks->cutouts[block.materials[lane]];
  if (cutout.width == 0) return false;
  const auto between = [&](std::size_t axis) {
    return static_cast<float>(block.uv[0][axis][lane]) * (1 - u - v) + static_cast<float>(block.uv[1][axis][lane]) * u +
           static_cast<float>(block.uv[2][axis][lane]) * v;
  };
  const float x = model.uv_origin.x + model.uv_step.x * between(0),
              y = model.uv_origin.y + model.uv_step.y * between(1);
  // Textures repeat. In whole numbers from here on: 2^20 parts of a texture.
  const auto column = ((static_cast<std::uint64_t>((x - std::floor(x)) * 0x1p20f) & 0xFFFFF) * cutout.width) >> 20;
  const auto row = ((static_cast<std::uint64_t>((y - std::floor(y)) * 0x1p20f) & 0xFFFFF) * cutout.height) >> 20;
  const std::uint64_t bit = row * cutout.width + column;
  return cutout.holes[bit >> 6] >> (bit & 63) & 1;
}

}  // namespace silvavis::scene
