#include "silvavis/levels/thin.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "silvavis/levels/silhouette.h"

namespace silvavis::levels {

namespace {

using assets::Model;

bool is_leaf(const assets::Material& material) {
  return material.alpha_cutoff > 0 || luminance(material.transmittance) > 0;
}

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

struct Leaf {
  std::uint32_t first = 0, count = 0;  // in Leaves::triangles
  V3 centre{0, 0, 0};
  float area = 0;
  std::uint64_t place = 0;  // along a curve through the crown
};

struct Leaves {
  std::vector<std::uint32_t> triangles;  // leaf by leaf, each leaf's in the model's order
  std::vector<Leaf> leaves;

  std::span<const std::uint32_t> of(const Leaf& leaf) const {
    return std::span(triangles).subspan(leaf.first, leaf.count);
  }
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

Leaves leaves_of(const Model& model) {
  Pieces pieces(model.positions.size());
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    if (!is_leaf(model.materials[model.triangle_materials[t]])) continue;
    pieces.join(model.triangles[t][0], model.triangles[t][1]);
    pieces.join(model.triangles[t][0], model.triangles[t][2]);
  }
  std::vector<std::uint32_t> number(model.positions.size(), 0xFFFFFFFF);
  Leaves all;
  std::vector<Leaf>& leaves = all.leaves;
  V3 least = model.positions[0], most = least;
  for (const V3& p : model.positions) {
    for (int axis = 0; axis < 3; ++axis) {
      least[axis] = std::min(least[axis], p[axis]);
      most[axis] = std::max(most[axis], p[axis]);
    }
  }
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
  const V3 size = most - least;
  const float side = std::max({size.x, size.y, size.z, 1e-6f});
  std::uint32_t sum = 0;
  for (Leaf& leaf : leaves) {
    if (leaf.area > 0) leaf.centre /= leaf.area;
    leaf.place = morton(leaf.centre, least, side);
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
  std::sort(leaves.begin(), leaves.end(), [&](const Leaf& a, const Leaf& b) {
    return a.place != b.place ? a.place < b.place : all.triangles[a.first] < all.triangles[b.first];
  });
  return all;
}

// The vertices of some triangles, in the model's order, and two that are as far apart as the whole model reaches, because
// meshoptimizer's errors are shares of that. It takes a hundred bytes for each vertex that it is shown.
struct FewVertices {
  std::vector<std::uint32_t> vertices;  // in the model
  std::vector<V3> positions;
  std::vector<unsigned int> indices;

  FewVertices(const Model& from, const std::vector<unsigned int>& corners) {
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

// The wood with about `target` triangles.
void add_wood(const Model& from, std::size_t target, Model& to) {
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

// How far the model reaches; enlarged leaves stay within, so that bounds made for the model hold for what replaces it.
struct Limits {
  float reach = 0, least_z = 0, most_z = 0;

  explicit Limits(const Model& model) : least_z(model.positions[0].z), most_z(least_z) {
    for (const V3& p : model.positions) {
      reach = std::max(reach, std::hypot(p.x, p.y));
      least_z = std::min(least_z, p.z);
      most_z = std::max(most_z, p.z);
    }
  }
  V3 within(V3 p) const {
    const float r = std::hypot(p.x, p.y);
    if (r > reach) {
      p.x *= reach / r;
      p.y *= reach / r;
    }
    p.z = std::clamp(p.z, least_z, most_z);
    return p;
  }
};

void add_leaf(const Model& from, const Leaf& leaf, std::span<const std::uint32_t> triangles, float across, float upward,
              const Limits& limits, Model& to, std::vector<std::uint32_t>& number) {
  for (const std::uint32_t t : triangles) {
    std::array<std::uint32_t, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t old = from.triangles[t][c];
      if (number[old] == 0xFFFFFFFF) {
        number[old] = static_cast<std::uint32_t>(to.positions.size());
        to.positions.push_back(
            limits.within(leaf.centre + (from.positions[old] - leaf.centre) * V3(across, across, upward)));
        to.normals.push_back(from.normals[old]);
        to.uvs.push_back(from.uvs[old]);
      }
      corners[c] = number[old];
    }
    to.triangles.push_back(corners);
    to.triangle_materials.push_back(from.triangle_materials[t]);
  }
}

// Covered area from the sides, up to 35 degrees from above.
double side_area(const Model& model, float cell_m) {
  const V3 views[] = {V3(1, 0.1f, -0.15f).normalized(), V3(-0.1f, 1, -0.4f).normalized(),
                      V3(-0.7f, -0.7f, -0.65f).normalized()};
  double sum = 0;
  for (const V3& view : views) sum += covered_area(model, view, cell_m);
  return sum / std::size(views);
}

// And from above.
double top_area(const Model& model, float cell_m) {
  return 0.5 *
         (covered_area(model, V3(0, 0, -1), cell_m) + covered_area(model, V3(0.3f, -0.4f, -1).normalized(), cell_m));
}

}  // namespace

Thinned thinned(const Model& model, double share) {
  const Leaves all = leaves_of(model);
  const std::vector<Leaf>& leaves = all.leaves;
  const auto wood_target =
      static_cast<std::size_t>(static_cast<double>(model.triangles.size() - all.triangles.size()) * share);

  Model bare;
  bare.name = model.name;
  bare.materials = model.materials;
  bare.textures = model.textures;
  add_wood(model, wood_target, bare);
  const auto kept = static_cast<std::size_t>(std::max(4.0, std::ceil(static_cast<double>(leaves.size()) * share)));
  const Limits limits(model);
  const auto with_leaves = [&](float across, float upward) {
    Model out = bare;
    std::vector<std::uint32_t> number(model.positions.size(), 0xFFFFFFFF);
    for (std::size_t i = 0; i < std::min(kept, leaves.size()); ++i) {
      // The middle of each even part of the curve.
      const Leaf& leaf = leaves[(2 * i + 1) * leaves.size() / (2 * std::min(kept, leaves.size()))];
      add_leaf(model, leaf, all.of(leaf), across, upward, limits, out, number);
    }
    return out;
  };
  if (leaves.empty()) return {std::move(bare), 1};

  const float cell_m = std::max({limits.reach, 0.5f * (limits.most_z - limits.least_z), 0.01f}) / 110;
  const double side = side_area(model, cell_m), top = top_area(model, cell_m);
  // The view from above tells how much wider leaves must be, the sides how much higher. Covered area grows a little less
  // than with the square of a side, which the exponents leave room for.
  auto across = static_cast<float>(0.9 / std::sqrt(share)), upward = across;
  const float least = 0.3f * across, most = 1.6f * across;
  Model out;
  for (int step = 0; step < 9; ++step) {
    out = with_leaves(across, upward);
    const double side_ratio = side / side_area(out, cell_m), top_ratio = top / top_area(out, cell_m);
    if (std::abs(side_ratio - 1) < 0.004 && std::abs(top_ratio - 1) < 0.004) break;
    across = std::clamp(static_cast<float>(static_cast<double>(across) * std::pow(top_ratio, 0.7)), least, most);
    upward = std::clamp(
        static_cast<float>(static_cast<double>(upward) * std::pow(side_ratio, 1.3) / std::pow(top_ratio, 0.6)), least,
        most);
  }
  return {std::move(out), std::sqrt(across * upward)};
}

float leaf_size(const Model& model) {
  std::vector<float> sizes;
  const Leaves all = leaves_of(model);
  for (const Leaf& leaf : all.leaves) sizes.push_back(std::sqrt(leaf.area));
  if (sizes.empty()) {
    for (const auto& t : model.triangles)
      sizes.push_back(std::sqrt(0.5f * (model.positions[t[1]] - model.positions[t[0]])
                                           .cross(model.positions[t[2]] - model.positions[t[0]])
                                           .length()));
  }
  std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2), sizes.end());
  return sizes[sizes.size() / 2];
}

}  // namespace silvavis::levels
