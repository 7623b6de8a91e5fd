// A model whose vertices bear colours, for formats that know no textures.
//
// Shape: triangles as the model's; a vertex that two materials share is there twice. Colours: sRGB-encoded.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "assets/model.h"

namespace ghosttile::exports {

struct Painted {
  struct Vertex {
    std::uint32_t of_model = 0;
    std::array<std::uint8_t, 3> rgb{};
  };
  std::vector<Vertex> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

// A vertex has the mean colour of what is seen of the texture in the halves of its triangles that are nearest to it; where
// nothing is seen there, that of the whole texture.
Painted painted(const assets::Model& model);

}  // namespace ghosttile::exports
