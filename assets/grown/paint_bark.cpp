#include <algorithm>

#include "assets/grown/canvas.h"
#include "assets/grown/paint.h"

namespace assets::grown {

namespace {

constexpr int size = 256;

// Octaves of noise, `stretch` times as many cells around as along.
float rough(float u, float v, int cells_u, int cells_v, std::uint32_t salt) {
  float sum = 0, weight = 0.5f;
  for (std::uint32_t octave = 0; octave < 3; ++octave) {
    sum += weight * tiling_noise(u * static_cast<float>(cells_u), v * static_cast<float>(cells_v), cells_u, cells_v,
                                 salt + octave);
    cells_u *= 2;
    cells_v *= 2;
    weight *= 0.5f;
  }
  return sum;
}

// Brightness of the bark at (u, v), around 1.
float fissured(float u, float v, std::uint32_t salt) {
  const float bent = u + 0.02f * rough(u, v, 4, 6, salt);
  const float ridge = std::abs(tiling_noise(bent * 14, v * 5, 14, 5, salt + 3));
  return 0.45f + 0.75f * smooth(0.02f, 0.45f, ridge) + 0.3f * rough(u, v, 24, 24, salt + 5);
}

float plated(float u, float v, std::uint32_t salt) {
  const float bent_u = u + 0.03f * rough(u, v, 5, 5, salt), bent_v = v + 0.03f * rough(u, v, 5, 5, salt + 9);
  const float a = std::abs(tiling_noise(bent_u * 10, bent_v * 7, 10, 7, salt + 3));
  const float b = std::abs(tiling_noise(bent_u * 18, bent_v * 12, 18, 12, salt + 4));
  return 0.5f + 0.5f * smooth(0.0f, 0.25f, a) + 0.2f * smooth(0.0f, 0.3f, b) + 0.3f * rough(u, v, 20, 16, salt + 5);
}

float stringy(float u, float v, std::uint32_t salt) {
  const float bent = u + 0.015f * rough(u, v, 3, 4, salt);
  const float strip = tiling_noise(bent * 32, v * 3, 32, 3, salt + 3);
  return 0.95f + 0.4f * strip + 0.25f * rough(u, v, 48, 8, salt + 5);
}

float even(float u, float v, std::uint32_t salt) {
  return 1 + 0.35f * rough(u, v, 5, 4, salt) + 0.12f * rough(u, v, 12, 40, salt + 5);
}

// Birch: white, fine dark lines around the stem, and dark diamonds. Returns the share of black.
float birch_marks(float u, float v, std::uint32_t salt) {
  const float line = tiling_noise(u * 6, v * 56, 6, 56, salt);
  const float where = tiling_noise(u * 5, v * 7, 5, 7, salt + 1);
  const float lines = smooth(0.5f, 0.75f, line) * smooth(-0.1f, 0.4f, where);
  const float patch = tiling_noise(u * 4, v * 4, 4, 4, salt + 2) + 0.5f * rough(u, v, 8, 16, salt + 3);
  return std::max(0.8f * lines, smooth(0.55f, 0.75f, patch));
}

}  // namespace

Texture paint_bark(Bark bark, const Rgb& mean_colour, std::uint64_t seed) {
  Canvas canvas(size, size);
  const auto salt = static_cast<std::uint32_t>(seed * 977 + 131 * static_cast<std::uint64_t>(bark));
  Rgb sum(0, 0, 0);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const float u = (static_cast<float>(x) + 0.5f) / size, v = (static_cast<float>(y) + 0.5f) / size;
      Rgb colour = mean_colour;
      if (bark == Bark::birch) {
        const float black = birch_marks(u, v, salt);
        colour = mix(mean_colour * (1 + 0.12f * rough(u, v, 4, 10, salt + 7)), Rgb(0.035f, 0.03f, 0.027f), black);
      } else {
        const float bright = bark == Bark::fissured  ? fissured(u, v, salt)
                             : bark == Bark::plated  ? plated(u, v, salt)
                             : bark == Bark::stringy ? stringy(u, v, salt)
                                                     : even(u, v, salt);
        // Moss and lichen shift the hue a little in patches.
        const float patch = 0.12f * rough(u, v, 3, 3, salt + 11);
        colour = mean_colour * std::max(0.25f, bright);
        colour = Rgb(colour.x * (1 - patch), colour.y, colour.z * (1 - 0.5f * patch));
      }
      canvas.at(x, y).colour = colour;
      sum += colour;
    }
  }
  // Bring the mean to the asked colour (birch keeps its white and its black).
  if (bark != Bark::birch) {
    const float count = static_cast<float>(size) * size;
    for (Texel& t : canvas.texels) {
      t.colour = Rgb(t.colour.x * mean_colour.x * count / sum.x, t.colour.y * mean_colour.y * count / sum.y,
                     t.colour.z * mean_colour.z * count / sum.z);
    }
  }
  return to_texture(std::move(canvas), "bark", false);
}

}  // namespace assets::grown
