#include <algorithm>
#include <cmath>
#include <limits>

#include "silvasim/base/parallel.h"
#include "silvavis/levels/silhouette.h"
#include "silvavis/scene/details.h"

namespace silvavis::scene {

namespace {

namespace tile = ghosttile::tile;
using silvasim::base::parallel_for;

Rgb texel_at(const assets::Texture& texture, const V2& uv, float cutoff, bool& hole) {
  const auto texel = [](float x, int size) {
    return static_cast<std::size_t>(
        std::min(static_cast<int>((x - std::floor(x)) * static_cast<float>(size)), size - 1));
  };
  const std::uint8_t* const pixel =
      texture.rgba.data() +
      (texel(uv.y, texture.height) * static_cast<std::size_t>(texture.width) + texel(uv.x, texture.width)) * 4;
  hole = static_cast<float>(pixel[3]) < cutoff * 255.0f;
  const auto linear = [](std::uint8_t byte) {
    const float encoded = static_cast<float>(byte) / 255;  // IEC 61966-2-1
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
  };
  return {linear(pixel[0]), linear(pixel[1]), linear(pixel[2])};
}

// Mean reflectance over the surface, holes left out.
Rgb mean_colour(const assets::Model& model) {
  constexpr float at[4][2] = {{1.0f / 3, 1.0f / 3}, {0.15f, 0.15f}, {0.7f, 0.15f}, {0.15f, 0.7f}};
  Rgb sum(0, 0, 0);
  float weight = 0;
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    const auto& corners = model.triangles[t];
    const V3 &a = model.positions[corners[0]], &b = model.positions[corners[1]], &c = model.positions[corners[2]];
    const float area = (b - a).cross(c - a).length();
    const assets::Material& material = model.materials[model.triangle_materials[t]];
    for (const auto& [u, v] : at) {
      Rgb colour = material.reflectance;
      bool hole = false;
      if (material.texture != assets::no_texture)
        colour *= texel_at(model.textures[static_cast<std::size_t>(material.texture)],
                           model.uvs[corners[0]] * (1 - u - v) + model.uvs[corners[1]] * u + model.uvs[corners[2]] * v,
                           material.alpha_cutoff, hole);
      if (hole) continue;
      sum += colour * area;
      weight += area;
    }
  }
  return weight > 0 ? sum / weight : Rgb(0, 0, 0);
}

float covered_m2(const assets::Model& model, float reach_m, const V3& direction) {
  constexpr float cells = 48;  // across
  return static_cast<float>(levels::covered_area(model, direction, 2 * reach_m / cells));
}

float reach_of(const assets::Model& model) {
  float square = 0;
  for (const V3& p : model.positions) square = std::max(square, p.length2());
  return std::sqrt(square);
}

}  // namespace

DetailKind detail_kind(const tile::GhostTile& tile, std::span<const std::uint32_t> models) {
  DetailKind kind;
  DetailLayer& layer = kind.empty;
  layer.side_m = static_cast<double>(tile.side_m);
  std::vector<float> reaches, areas;
  for (const auto& object : tile.objects) {
    layer.objects.push_back(object.name);
    kind.colours.push_back(mean_colour(object.model));
    const float reach = std::max(reach_of(object.model), 1e-6f);
    reaches.push_back(reach);
    // The means over all directions, from seven that are spread evenly.
    constexpr float d = 0.57735f;
    float area = 0;
    for (const V3& from :
         {V3(1, 0, 0), V3(0, 1, 0), V3(0, 0, 1), V3(d, d, d), V3(-d, d, d), V3(d, -d, d), V3(d, d, -d)})
      area += covered_m2(object.model, reach, from);
    areas.push_back(std::max(area / 7, 1e-10f));
  }
  const std::size_t count = tile.candidates.size();
  layer.frames.resize(count);
  kind.covered_m2.resize(count);
  for (std::size_t a = 0; a < 3; ++a) {
    layer.least_m[a].resize(count);
    layer.most_m[a].resize(count);
  }
  parallel_for(count, [&](std::size_t c) {
    const tile::Candidate& from = tile.candidates[c];
    const assets::Model& model = tile.objects[from.object].model;
    DetailFrame& frame = layer.frames[c];
    frame.at = from.at;
    frame.scale = from.scale;
    frame.w = from.rotation.w;
    frame.x = from.rotation.x;
    frame.y = from.rotation.y;
    frame.z = from.rotation.z;
    frame.model = models[from.object];
    frame.object = from.object;
    frame.size_m = from.scale * std::sqrt(areas[from.object]);
    V3 least(std::numeric_limits<float>::max()), most(std::numeric_limits<float>::lowest());
    for (const V3& p : model.positions) {
      const V3 at = from(p);
      for (int a = 0; a < 3; ++a) {
        least[a] = std::min(least[a], at[a]);
        most[a] = std::max(most[a], at[a]);
      }
    }
    // Packed models are rounded to a part of their size; and floats' rounding.
    const float slack = 1e-5f + 4e-5f * reaches[from.object] * from.scale;
    for (int a = 0; a < 3; ++a) {
      layer.least_m[static_cast<std::size_t>(a)][c] = least[a] - slack;
      layer.most_m[static_cast<std::size_t>(a)][c] = most[a] + slack;
    }
    kind.covered_m2[c] =
        from.scale * from.scale * covered_m2(model, reaches[from.object], frame.turned_back(V3(0, 0, 1)));
  });
  return kind;
}

}  // namespace silvavis::scene
