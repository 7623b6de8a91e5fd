// A model's triangles, material by material, as most formats want them.
//
// Shape: materials ascending, those without triangles left out; within one in the model's order.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "assets/model.h"

namespace ghosttile::exports {

struct Group {
  std::size_t material = 0;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

inline std::vector<Group> groups_of(const assets::Model& model) {
  std::vector<Group> all(model.materials.size());
  for (std::size_t m = 0; m < all.size(); ++m) all[m].material = m;
  for (std::size_t t = 0; t < model.triangles.size(); ++t)
    all[model.triangle_materials[t]].triangles.push_back(model.triangles[t]);
  std::erase_if(all, [](const Group& group) { return group.triangles.empty(); });
  return all;
}

// Whether its texture coordinates mean anything.
inline bool textured(const assets::Model& model) {
  for (const assets::Material& material : model.materials)
    if (material.texture != assets::no_texture) return true;
  return false;
}

}  // namespace ghosttile::exports
