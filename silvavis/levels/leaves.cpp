#include "silvavis/levels/leaves.h"

#include <algorithm>
#include <numeric>

namespace silvavis::levels {

namespace {

// Pieces of triangles that share corners.
class Pieces {
 public:
  explicit Pieces(std::size_t corners) : parent_(corners) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  // The lower number is the root, so that the order of joining does not matter.
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

// The place on a Morton curve of 2^16 steps a side, so that even steps through the order are even in space.
std::uint64_t morton(const V3& p, const V3& least, float size) {
  std::uint64_t code = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<std::uint64_t>(std::clamp((p[axis] - least[axis]) / size, 0.0f, 0.9999f) * 65536.0f);
    for (int bit = 0; bit < 16; ++bit) code |= (at >> bit & 1) << (3 * bit + axis);
  }
  return code;
}

}  // namespace

bool is_leaf(const assets::Material& material) {
  return material.alpha_cutoff > 0 || luminance(material.transmittance) > 0;
}

Leaves leaves_of(const assets::Model& model) {
  Pieces pieces(model.positions.size());
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    if (!is_leaf(model.materials[model.triangle_materials[t]])) continue;
    pieces.join(model.triangles[t][0], model.triangles[t][1]);
    pieces.join(model.triangles[t][0], model.triangles[t][2]);
  }
  std::vector<std::uint32_t> number(model.positions.size(), 0xFFFFFFFF);
  Leaves all;
  std::vector<Leaf>& leaves = all.leaves;
  for (std::uint32_t t = 0; t < model.triangles.size(); ++t) {
    if (!is_leaf(model.materials[model.triangle_materials[t]])) continue;
    const std::uint32_t root = pieces.root(model.triangles[t][0]);
    if (number[root] == 0xFFFFFFFF) {
      number[root] = static_cast<std::uint32_t>(leaves.size());
      leaves.emplace_back();
    }
    Leaf& leaf = leaves[number[root]];
    const V3 &a = model.positions[model.triangles[t][0]], &b = model.positions[model.triangles[t][1]],
             &c = model.positions[model.triangles[t][2]];
    const float area = 0.5f * (b - a).cross(c - a).length();
    ++leaf.count;
    leaf.centre += (a + b + c) * (area / 3);
    leaf.area += area;
  }
  std::uint32_t sum = 0;
  for (Leaf& leaf : leaves) {
    if (leaf.area > 0) leaf.centre /= leaf.area;
    leaf.first = sum;
    sum += leaf.count;
    leaf.count = 0;
  }
  all.triangles.resize(sum);
  for (std::uint32_t t = 0; t < model.triangles.size(); ++t) {
    if (!is_leaf(model.materials[model.triangle_materials[t]])) continue;
    Leaf& leaf = leaves[number[pieces.root(model.triangles[t][0])]];
    all.triangles[leaf.first + leaf.count++] = t;
  }
  return all;
}

void put_along_curve(const assets::Model& model, Leaves& leaves) {
  V3 least = model.positions[0], most = least;
  for (const V3& p : model.positions) {
    for (int axis = 0; axis < 3; ++axis) {
      least[axis] = std::min(least[axis], p[axis]);
      most[axis] = std::max(most[axis], p[axis]);
    }
  }
  const V3 size = most - least;
  const float side = std::max({size.x, size.y, size.z, 1e-6f});
  for (Leaf& leaf : leaves.leaves) leaf.place = morton(leaf.centre, least, side);
  std::sort(leaves.leaves.begin(), leaves.leaves.end(), [&](const Leaf& a, const Leaf& b) {
    return a.place != b.place ? a.place < b.place : leaves.triangles[a.first] < leaves.triangles[b.first];
  });
}

}  // namespace silvavis::levels
