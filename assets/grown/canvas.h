// A small picture in linear colours to paint textures on, and its conversion to bytes.
#pragma once

#include <string>
#include <vector>

#include "assets/grown/draws.h"
#include "assets/model.h"

namespace assets::grown {

struct Texel {
  Rgb colour{0, 0, 0};
  float alpha = 0;
};

struct Canvas {
  int width, height;
  std::vector<Texel> texels;

  Canvas(int w, int h) : width(w), height(h), texels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  Texel& at(int x, int y) {
    return texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

// sRGB's encoding of a linear share, 0 to 255.
std::uint8_t encoded(float linear);

// With alpha: colours grow outward into the transparent texels, so that filtering at edges does not darken them.
Texture to_texture(Canvas canvas, const std::string& name, bool has_alpha);

// Noise in [-1,1] that repeats after `period` cells in both directions.
float tiling_noise(float x, float y, int period_x, int period_y, std::uint32_t salt);

}  // namespace assets::grown
