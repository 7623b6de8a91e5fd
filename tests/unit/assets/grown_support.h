// What the tests of grown plants measure, by means other than the generator's.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "assets/grown/grow.h"
#include "assets/model.h"

namespace assets::grown_tests {

struct Case {
  grown::Form form;
  double height_m, radius_m;
};

// Every form at a size that its species has.
inline std::vector<Case> cases() {
  std::vector<Case> all;
  for (const grown::Form& form : grown::all_forms()) {
    const bool low = form.habit != grown::Habit::woody, shrub = form.stems > 1;
    all.push_back({form, low ? 0.7 : shrub ? 4.5 : 26, low ? 0.45 : shrub ? 1.8 : 4.2});
  }
  return all;
}

inline float reach(const V3& p) { return std::sqrt(p.x * p.x + p.y * p.y); }

inline const std::uint8_t* texel(const Texture& texture, float u, float v) {
  const auto wrap = [](float x, int n) {
    return std::min(n - 1, static_cast<int>((x - std::floor(x)) * static_cast<float>(n)));
  };
  const int x = wrap(u, texture.width), y = wrap(v, texture.height);
  return texture.rgba.data() +
         4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(texture.width) + static_cast<std::size_t>(x));
}

// Which cells of a picture are covered, seen without perspective: by what is cut out of the leaves as well.
struct Silhouette {
  int columns = 0, rows = 0;
  std::vector<char> covered;
  double share() const {
    return static_cast<double>(std::count(covered.begin(), covered.end(), 1)) / static_cast<double>(covered.size());
  }
};

// The box [-radius, radius] x [0, height], seen along the horizontal direction at `azimuth`; or the disc's square from
// above.
inline Silhouette silhouette(const Model& model, double height_m, double radius_m, double azimuth, bool from_above) {
  Silhouette picture;
  picture.columns = 240;
  picture.rows = from_above ? 240 : 400;
  picture.covered.assign(static_cast<std::size_t>(picture.columns) * static_cast<std::size_t>(picture.rows), 0);
  const double c = std::cos(azimuth), s = std::sin(azimuth);
  const auto across = [&](const V3& p) { return ((p.x * c + p.y * s) / radius_m + 1) / 2 * picture.columns; };
  const auto down = [&](const V3& p) {
    return from_above ? ((-p.x * s + p.y * c) / radius_m + 1) / 2 * picture.rows : (1 - p.z / height_m) * picture.rows;
  };
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    const auto& [a, b, d] = model.triangles[t];
    const Material& material = model.materials[model.triangle_materials[t]];
    const double x0 = across(model.positions[a]), y0 = down(model.positions[a]);
    const double x1 = across(model.positions[b]), y1 = down(model.positions[b]);
    const double x2 = across(model.positions[d]), y2 = down(model.positions[d]);
    const double area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0);
    if (area == 0) continue;
    const int left = std::max(0, static_cast<int>(std::min({x0, x1, x2}))),
              right = std::min(picture.columns - 1, static_cast<int>(std::max({x0, x1, x2})));
    const int top = std::max(0, static_cast<int>(std::min({y0, y1, y2}))),
              bottom = std::min(picture.rows - 1, static_cast<int>(std::max({y0, y1, y2})));
    for (int y = top; y <= bottom; ++y) {
      for (int x = left; x <= right; ++x) {
        const double px = x + 0.5, py = y + 0.5;
        const double u = ((px - x0) * (y2 - y0) - (x2 - x0) * (py - y0)) / area,
                     v = ((x1 - x0) * (py - y0) - (px - x0) * (y1 - y0)) / area;
        if (u < 0 || v < 0 || u + v > 1) continue;
        if (material.alpha_cutoff > 0) {
          const V2 uv = model.uvs[a] * static_cast<float>(1 - u - v) + model.uvs[b] * static_cast<float>(u) +
                        model.uvs[d] * static_cast<float>(v);
          if (texel(model.textures[static_cast<std::size_t>(material.texture)], uv.x, uv.y)[3] <
              255 * material.alpha_cutoff)
            continue;
        }
        picture.covered[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.columns) +
                        static_cast<std::size_t>(x)] = 1;
      }
    }
  }
  return picture;
}

inline double linear(std::uint8_t byte) {
  const double s = byte / 255.0;
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

// Mean colour of what is opaque in a material, and the share that is.
struct Seen {
  double red = 0, green = 0, blue = 0, opaque = 1;
};
inline Seen seen(const Model& model, const Material& material) {
  Seen sum;
  if (material.texture == no_texture)
    return {material.reflectance.x, material.reflectance.y, material.reflectance.z, 1};
  const Texture& texture = model.textures[static_cast<std::size_t>(material.texture)];
  double count = 0;
  for (std::size_t i = 0; i < texture.rgba.size(); i += 4) {
    if (texture.rgba[i + 3] < 255 * material.alpha_cutoff) continue;
    sum.red += linear(texture.rgba[i]);
    sum.green += linear(texture.rgba[i + 1]);
    sum.blue += linear(texture.rgba[i + 2]);
    ++count;
  }
  return {sum.red / count * material.reflectance.x, sum.green / count * material.reflectance.y,
          sum.blue / count * material.reflectance.z, count * 4 / static_cast<double>(texture.rgba.size())};
}

}  // namespace assets::grown_tests
