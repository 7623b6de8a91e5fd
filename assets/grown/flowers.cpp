#include "assets/grown/flowers.h"

#include <algorithm>

#include "assets/grown/canvas.h"
#include "assets/grown/paint.h"

namespace assets::grown {

namespace {

// A flat head of many small round flowers.
Texture paint_head(const Rgb& colour, std::uint64_t seed) {
  constexpr int size = 64;
  Canvas canvas(size, size);
  Draws draws(seed, 7);
  for (int i = 0; i < 90; ++i) {
    const SinCos a = sin_cos(2 * pi * draws.share());
    const float r = 26 * std::sqrt(draws.share());
    const float x = 0.5f * size + r * a.cos, y = 0.5f * size + r * a.sin, radius = draws.between(1.8f, 3.4f);
    const Rgb shade = colour * draws.between(0.75f, 1.15f);
    for (int j = static_cast<int>(y - 5); j <= static_cast<int>(y + 5); ++j) {
      for (int k = static_cast<int>(x - 5); k <= static_cast<int>(x + 5); ++k) {
        if (j < 0 || k < 0 || j >= size || k >= size) continue;
        const float dx = static_cast<float>(k) + 0.5f - x, dy = static_cast<float>(j) + 0.5f - y;
        const float alpha = clamp01(radius - std::sqrt(dx * dx + dy * dy) + 0.5f);
        if (alpha <= 0) continue;
        Texel& texel = canvas.at(k, j);
        texel.colour = shade;
        texel.alpha = std::max(texel.alpha, alpha);
      }
    }
  }
  return to_texture(std::move(canvas), "flowers", true);
}

}  // namespace

std::size_t add_flowers(Model& model, const Skeleton& skeleton, const Form& form, float height_m, std::uint64_t seed) {
  if (form.flowers == 0) return 0;
  // Twigs that end in the upper, outer crown.
  std::vector<const Axis*> twigs;
  for (const Axis& axis : skeleton.axes) {
    const bool wanted = form.habit == Habit::herb ? axis.order == 0 : axis.order == form.orders;
    if (wanted && spot_at(skeleton, axis, 1).position.z > mix(form.crown_base, 1.0f, 0.35f) * height_m)
      twigs.push_back(&axis);
  }
  if (twigs.empty()) return 0;
  Material material;
  material.name = "flowers";
  material.reflectance = Rgb(1, 1, 1);
  material.transmittance = Rgb(0.3f, 0.3f, 0.3f);
  material.texture = static_cast<int>(model.textures.size());
  material.alpha_cutoff = 0.5f;
  const auto index = static_cast<std::uint16_t>(model.materials.size());
  model.materials.push_back(material);
  model.textures.push_back(paint_head(form.flower_colour, seed));
  Draws draws(seed, 8);
  const auto count = std::min<std::size_t>(static_cast<std::size_t>(form.flowers), twigs.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Spot tip = spot_at(skeleton, *twigs[i * twigs.size() / count], 1);
    const V3 normal = unit(V3(0, 0, 0.7f) + tip.direction * 0.5f + draws.direction() * 0.7f);
    const V3 u = beside(tip.direction + draws.direction() * 0.1f, normal), v = normal.cross(u);
    const float half = 0.5f * form.flower_size_m * draws.between(0.75f, 1.15f);
    const auto base = static_cast<std::uint32_t>(model.positions.size());
    const V3 centre = tip.position + normal * (0.15f * half);
    for (const auto& [x, y] : {std::pair{-1.0f, -1.0f}, {1.0f, -1.0f}, {1.0f, 1.0f}, {-1.0f, 1.0f}}) {
      model.positions.push_back(centre + (u * x + v * y) * half);
      model.normals.push_back(normal);
      model.uvs.push_back({0.5f + 0.5f * x, 0.5f - 0.5f * y});
    }
    model.triangles.push_back({base, base + 1, base + 2});
    model.triangles.push_back({base, base + 2, base + 3});
    model.triangle_materials.insert(model.triangle_materials.end(), 2, index);
  }
  return 2 * count;
}

}  // namespace assets::grown
