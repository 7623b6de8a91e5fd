// A plant as triangles, however it came: read from a file, or grown by the project.
//
// Units: metres, z up, the stem's foot at the origin. Promise of every maker: all numbers finite, all indices in range,
// normals of unit length, one triangle at least, none without an area, `uvs` as many as positions.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "assets/vector.h"

namespace assets {

// 8 bits a channel, row 0 at the top (v = 0); colours are sRGB-encoded, alpha is linear. Repeats beyond [0,1].
struct Texture {
  std::string name;
  int width = 0;
  int height = 0;
  bool has_alpha = false;          // false: every alpha is 255
  std::vector<std::uint8_t> rgba;  // width * height * 4

  friend bool operator==(const Texture&, const Texture&) = default;
};

inline constexpr int no_texture = -1;

struct Material {
  std::string name;
  Rgb reflectance{0.5f, 0.5f, 0.5f};  // diffuse, multiplied with the texture's colour
  Rgb transmittance{0.0f, 0.0f,
                    0.0f};   // light that passes a thin leaf, diffuse on the other side; with the texture too
  int texture = no_texture;  // index into Model::textures
  float alpha_cutoff = 0;    // a hit where the texture's alpha is below it goes through; 0: opaque
  bool two_sided = true;     // false: seen from behind, the surface is not there

  friend bool operator==(const Material&, const Material&) = default;
};

struct Model {
  std::string name;
  std::vector<V3> positions;
  std::vector<V3> normals;  // for shading; of the side on which the triangle runs anticlockwise
  std::vector<V2> uvs;      // u to the right, v down; zero where there is no texture
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint16_t> triangle_materials;  // one a triangle: index into `materials`
  std::vector<Material> materials;                // one at least
  std::vector<Texture> textures;
};

}  // namespace assets
