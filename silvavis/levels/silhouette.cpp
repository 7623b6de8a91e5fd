#include "silvavis/levels/silhouette.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace silvavis::levels {

namespace {

bool is_hole(const assets::Model& model, std::size_t triangle, float u, float v) {
  const assets::Material& material = model.materials[model.triangle_materials[triangle]];
  if (material.alpha_cutoff <= 0 || material.texture == assets::no_texture) return false;
  const assets::Texture& texture = model.textures[static_cast<std::size_t>(material.texture)];
  const auto& corners = model.triangles[triangle];
  const V2 at = model.uvs[corners[0]] * (1 - u - v) + model.uvs[corners[1]] * u + model.uvs[corners[2]] * v;
  const auto texel = [](float x, int size) {
    return std::min(static_cast<int>((x - std::floor(x)) * static_cast<float>(size)), size - 1);
  };
  const auto index = static_cast<std::size_t>(texel(at.y, texture.height)) * static_cast<std::size_t>(texture.width) +
                     static_cast<std::size_t>(texel(at.x, texture.width));
  return static_cast<float>(texture.rgba[index * 4 + 3]) < material.alpha_cutoff * 255.0f;
}

}  // namespace

double covered_area(const assets::Model& model, const V3& direction, float cell_m) {
  const V3 aside = std::abs(direction.z) < 0.9f ? V3(0, 0, 1) : V3(1, 0, 0);
  const V3 right = direction.cross(aside).normalized(), up = right.cross(direction);
  std::vector<V2> at(model.positions.size());
  V2 least(std::numeric_limits<float>::max()), most(std::numeric_limits<float>::lowest());
  for (std::size_t i = 0; i < at.size(); ++i) {
    at[i] = V2(model.positions[i].dot(right), model.positions[i].dot(up)) / cell_m;
    least = {std::min(least.x, at[i].x), std::min(least.y, at[i].y)};
    most = {std::max(most.x, at[i].x), std::max(most.y, at[i].y)};
  }
  const auto columns = static_cast<std::size_t>(most.x - least.x) + 2,
             rows = static_cast<std::size_t>(most.y - least.y) + 2;
  std::vector<std::uint8_t> covered(columns * rows, 0);
  std::size_t count = 0;
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    const V2 a = at[model.triangles[t][0]] - least, b = at[model.triangles[t][1]] - least,
             c = at[model.triangles[t][2]] - least;
    const V2 e1 = b - a, e2 = c - a;
    const float area = e1.x * e2.y - e1.y * e2.x;
    if (area == 0) continue;
    // Cells whose centres, at whole numbers and a half, lie within the triangle's box.
    const auto first = [](float x, float y, float z) {
      return static_cast<std::size_t>(std::max(0.0f, std::ceil(std::min({x, y, z}) - 0.5f)));
    };
    const auto last = [](float x, float y, float z) { return std::floor(std::max({x, y, z}) - 0.5f); };
    const float last_row = last(a.y, b.y, c.y), last_column = last(a.x, b.x, c.x);
    for (std::size_t row = first(a.y, b.y, c.y); static_cast<float>(row) <= last_row; ++row) {
      for (std::size_t column = first(a.x, b.x, c.x); static_cast<float>(column) <= last_column; ++column) {
        std::uint8_t& cell = covered[row * columns + column];
        if (cell) continue;
        const V2 p = V2(static_cast<float>(column) + 0.5f, static_cast<float>(row) + 0.5f) - a;
        const float u = (p.x * e2.y - p.y * e2.x) / area, v = (e1.x * p.y - e1.y * p.x) / area;
        if (u < 0 || v < 0 || u + v > 1 || is_hole(model, t, u, v)) continue;
        cell = 1;
        ++count;
      }
    }
  }
  return static_cast<double>(count) * static_cast<double>(cell_m) * static_cast<double>(cell_m);
}

}  // namespace silvavis::levels
