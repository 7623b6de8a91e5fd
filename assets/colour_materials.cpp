#include "assets/colour_materials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace assets {

namespace {

constexpr std::size_t most_shades = 64;

struct Shade {
  V3d sum{0.0, 0.0, 0.0};
  double area = 0;
  std::uint32_t material = 0;
};

using Cell = std::array<int, 3>;

// A cell of colours alike to the eye: the square root is near to the eye's scale.
Cell cell(const Rgb& colour, int levels) {
  Cell c{};
  for (int i = 0; i < 3; ++i) {
    const float share = std::sqrt(std::clamp(colour[i], 0.0f, 1.0f));
    c[static_cast<std::size_t>(i)] = std::min(levels - 1, static_cast<int>(share * static_cast<float>(levels)));
  }
  return c;
}

}  // namespace

void fold_colours(Draft& draft, std::vector<Material>& materials) {
  const std::size_t count = materials.size();
  std::vector<Rgb> colours(draft.triangles.size());
  std::vector<std::vector<std::uint32_t>> triangles_of(count);
  for (std::size_t i = 0; i < draft.triangles.size(); ++i) {
    const auto& [a, b, c] = draft.triangles[i];
    Rgb mean = (draft.colours[a] + draft.colours[b] + draft.colours[c]) / 3.0f;
    for (int k = 0; k < 3; ++k) mean[k] = std::isfinite(mean[k]) ? std::clamp(mean[k], 0.0f, 1.0f) : 1.0f;
    colours[i] = mean;
    triangles_of[draft.triangle_materials[i]].push_back(static_cast<std::uint32_t>(i));
  }

  const auto is_grey = [&](std::uint32_t t) {
    const Rgb& c = colours[t];
    return std::max({c.x, c.y, c.z}) - std::min({c.x, c.y, c.z}) < 0.01f;
  };
  for (std::uint32_t m = 0; m < count; ++m) {
    const std::vector<std::uint32_t>& own = triangles_of[m];
    if (own.empty()) continue;
    if (materials[m].texture != no_texture && std::all_of(own.begin(), own.end(), is_grey)) continue;

    // Coarsen the grid of colours until few enough cells are used.
    std::map<Cell, Shade> shades;
    int levels = 32;
    for (;; levels /= 2) {
      shades.clear();
      for (const std::uint32_t t : own) {
        shades.try_emplace(cell(colours[t], levels));
        if (shades.size() > most_shades) break;
      }
      if (shades.size() <= most_shades) break;
    }
    for (const std::uint32_t t : own) {
      const auto& [a, b, c] = draft.triangles[t];
      const V3d origin(draft.positions[a]);
      const double area = (V3d(draft.positions[b]) - origin).cross(V3d(draft.positions[c]) - origin).length();
      Shade& shade = shades[cell(colours[t], levels)];
      shade.sum += V3d(colours[t].x, colours[t].y, colours[t].z) * area;
      shade.area += area;
    }
    const Material original = materials[m];
    bool first = true;
    for (auto& [key, shade] : shades) {
      const V3d mean = shade.sum / shade.area;
      const Rgb factor(static_cast<float>(mean.x), static_cast<float>(mean.y), static_cast<float>(mean.z));
      Material material = original;
      material.reflectance = original.reflectance * factor;
      material.transmittance = original.transmittance * factor;
      shade.material = first ? m : static_cast<std::uint32_t>(materials.size());
      if (first) {
        materials[m] = material;
      } else {
        materials.push_back(material);
      }
      first = false;
    }
    for (const std::uint32_t t : own) {
      draft.triangle_materials[t] = shades[cell(colours[t], levels)].material;
    }
  }
}

}  // namespace assets
