// Textures of bark and of leaf sprays, painted by the code.
#pragma once

#include <cstdint>

#include "assets/grown/form.h"
#include "assets/model.h"

namespace assets::grown {

// 256 x 256, repeats in both directions without a seam; u runs around the stem, v down.
Texture paint_bark(Bark bark, const Rgb& mean_colour, std::uint64_t seed);

// Four different sprays in a 2 x 2 atlas, each with its foot at the middle of its lower edge.
struct Sprays {
  Texture texture;
  float filled = 0;  // share of a spray's square that is opaque
};
// A spray of `spray_length_m` holds as many leaves of the form as there is room for.
Sprays paint_sprays(const Form& form, float spray_length_m, std::uint64_t seed);

// Adds three materials of the form's leaves, from darker and bluer to lighter and yellower, that share the texture.
// Returns the first one's index.
std::uint16_t add_leaf_materials(Model& model, const Form& form, Texture texture);

}  // namespace assets::grown
