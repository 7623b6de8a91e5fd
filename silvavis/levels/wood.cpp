#include "silvavis/levels/wood.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "silvavis/levels/leaves.h"

namespace silvavis::levels {

namespace {

// The vertices of some triangles, in the model's order, and two that are as far apart as the whole model reaches, because
// meshoptimizer's errors are shares of that. It takes a hundred bytes for each vertex that it is shown.
struct FewVertices {
  std::vector<std::uint32_t> vertices;  // in the model
  std::vector<V3> positions;
  std::vector<unsigned int> indices;

  FewVertices(const assets::Model& from, const std::vector<unsigned int>& corners) {
    std::vector<std::uint32_t> number(from.positions.size(), 0xFFFFFFFF);
    for (const unsigned int corner : corners) number[corner] = 0;
    V3 least = from.positions[0], most = least;
    for (std::uint32_t v = 0; v < number.size(); ++v) {
      const V3& p = from.positions[v];
      for (int axis = 0; axis < 3; ++axis) {
        least[axis] = std::min(least[axis], p[axis]);
        most[axis] = std::max(most[axis], p[axis]);
      }
      if (number[v] != 0) continue;
      number[v] = static_cast<std::uint32_t>(vertices.size());
      vertices.push_back(v);
      positions.push_back(p);
    }
    positions.push_back(least);
    positions.push_back(most);
    for (const unsigned int corner : corners) indices.push_back(number[corner]);
  }
};

}  // namespace

void add_wood(const assets::Model& from, std::size_t target, assets::Model& to) {
  // A texture per material, so material by material.
  std::vector<std::vector<unsigned int>> by_material(from.materials.size());
  std::size_t all = 0;
  for (std::size_t t = 0; t < from.triangles.size(); ++t) {
    const std::uint16_t material = from.triangle_materials[t];
    if (is_leaf(from.materials[material])) continue;
    by_material[material].insert(by_material[material].end(), from.triangles[t].begin(), from.triangles[t].end());
    ++all;
  }
  std::vector<std::uint32_t> number(from.positions.size(), 0xFFFFFFFF);
  for (std::size_t m = 0; m < by_material.size(); ++m) {
    auto& indices = by_material[m];
    if (indices.empty()) continue;
    const std::size_t wanted =
        std::max<std::size_t>(4, indices.size() / 3 * target / std::max<std::size_t>(all, 1)) * 3;
    if (wanted < indices.size()) {
      std::vector<unsigned int> simpler(indices.size());
      std::optional<FewVertices> few(std::in_place, from, indices);
      std::size_t count = meshopt_simplify(simpler.data(), few->indices.data(), indices.size(), &few->positions[0].x,
                                           few->positions.size(), sizeof(V3), wanted, 1.0f, 0, nullptr);
      for (std::size_t i = 0; i < count; ++i) simpler[i] = few->vertices[simpler[i]];
      few.reset();
      if (count > wanted + wanted / 2) {
        count = meshopt_simplifySloppy(simpler.data(), indices.data(), indices.size(), &from.positions[0].x,
                                       from.positions.size(), sizeof(V3), wanted, 1.0f, nullptr);
      }
      simpler.resize(count);
      indices = std::move(simpler);
    }
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
      std::array<std::uint32_t, 3> corners;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t old = indices[i + c];
        if (number[old] == 0xFFFFFFFF) {
          number[old] = static_cast<std::uint32_t>(to.positions.size());
          to.positions.push_back(from.positions[old]);
          to.normals.push_back(from.normals[old]);
          to.uvs.push_back(from.uvs[old]);
        }
        corners[c] = number[old];
      }
      to.triangles.push_back(corners);
      to.triangle_materials.push_back(static_cast<std::uint16_t>(m));
    }
  }
}

}  // namespace silvavis::levels
