#include "silvavis/levels/thin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "silvavis/levels/leaves.h"
#include "silvavis/levels/silhouette.h"
#include "silvavis/levels/wood.h"

namespace silvavis::levels {

namespace {

using assets::Model;

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
  Leaves all = leaves_of(model);
  put_along_curve(model, all);
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
