#include "ghosttile/export/painted.h"

#include <cmath>
#include <map>

#include "assets/srgb.h"
#include "assets/texture.h"

namespace ghosttile::exports {

namespace {

using assets::Rgb;
using assets::V2;

struct Sum {
  Rgb light{0, 0, 0};
  float texels = 0;
};

std::size_t texel(float at, int size) {
  const float share = at - std::floor(at);  // textures repeat
  return static_cast<std::size_t>(std::min(static_cast<int>(share * static_cast<float>(size)), size - 1));
}

void add_texel(const assets::Texture& texture, float cutoff, const V2& uv, Sum& sum) {
  const std::size_t row = texel(uv.y, texture.height), column = texel(uv.x, texture.width);
  const std::uint8_t* rgba = &texture.rgba[4 * (row * static_cast<std::size_t>(texture.width) + column)];
  if (static_cast<float>(rgba[3]) < cutoff * 255.0f) return;
  const auto& linear = assets::linear_of_bytes();
  sum.light += Rgb(linear[rgba[0]], linear[rgba[1]], linear[rgba[2]]);
  sum.texels += 1;
}

// A lattice in the half of a triangle that is nearest to its corner `a`.
void add_corner(const assets::Texture& texture, float cutoff, const V2& a, const V2& b, const V2& c, Sum& sum) {
  constexpr int steps = 8;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; i + j <= steps; ++j) {
      const float to_b = static_cast<float>(i) / (2 * steps), to_c = static_cast<float>(j) / (2 * steps);
      add_texel(texture, cutoff, a + (b - a) * to_b + (c - a) * to_c, sum);
    }
  }
}

}  // namespace

Painted painted(const assets::Model& model) {
  Painted result;
  std::vector<std::uint16_t> material_of;  // by vertex of the result, as the next
  std::vector<Sum> sums;
  std::map<std::pair<std::uint32_t, std::uint16_t>, std::uint32_t> numbers;
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    const std::uint16_t m = model.triangle_materials[t];
    const assets::Material& material = model.materials[m];
    const auto& corners = model.triangles[t];
    auto& triangle = result.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto next = static_cast<std::uint32_t>(result.vertices.size());
      const auto [at, is_new] = numbers.try_emplace({corners[k], m}, next);
      if (is_new) {
        result.vertices.push_back({corners[k], {}});
        material_of.push_back(m);
        sums.emplace_back();
      }
      triangle[k] = at->second;
      if (material.texture == assets::no_texture) continue;
      add_corner(model.textures[static_cast<std::size_t>(material.texture)], material.alpha_cutoff,
                 model.uvs[corners[k]], model.uvs[corners[(k + 1) % 3]], model.uvs[corners[(k + 2) % 3]],
                 sums[at->second]);
    }
  }

  // What stands in where nothing is seen.
  std::vector<Rgb> means;
  for (const assets::Material& material : model.materials) {
    const bool plain = material.texture == assets::no_texture;
    means.push_back(
        plain ? Rgb(1, 1, 1)
              : assets::mean_colour(model.textures[static_cast<std::size_t>(material.texture)], material.alpha_cutoff));
  }
  for (std::size_t v = 0; v < sums.size(); ++v) {
    const Rgb of_texture = sums[v].texels > 0 ? sums[v].light / sums[v].texels : means[material_of[v]];
    const Rgb colour = model.materials[material_of[v]].reflectance * of_texture;
    result.vertices[v].rgb = {assets::byte_of_linear(colour.x), assets::byte_of_linear(colour.y),
                              assets::byte_of_linear(colour.z)};
  }
  return result;
}

}  // namespace ghosttile::exports
