// Pictures in memory: linear floats, and what else a frame knows of each pixel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "silvavis/base/vector.h"

namespace silvavis::image {

// Row 0 is the top. Channels interleaved; linear, with the primaries of sRGB where they are colours.
struct Image {
  int width = 0;
  int height = 0;
  int channels = 3;
  std::vector<float> pixels;  // width * height * channels

  Image() = default;
  Image(int width_px, int height_px, int channels_a_pixel)
      : width(width_px),
        height(height_px),
        channels(channels_a_pixel),
        pixels(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px) *
               static_cast<std::size_t>(channels_a_pixel)) {}

  bool empty() const { return pixels.empty(); }
  float* at(int x, int y) {
    return pixels.data() +
           (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(channels);
  }
  const float* at(int x, int y) const { return const_cast<Image*>(this)->at(x, y); }

  friend bool operator==(const Image&, const Image&) = default;
};

inline constexpr double cd_m2_per_unit = 39226;  // of a luminance of 1 (docs/light.md)

inline constexpr std::uint16_t species_sky = 0xFFFF;     // nothing was hit
inline constexpr std::uint16_t species_ground = 0xFFFE;  // the terrain
inline constexpr std::uint16_t species_water = 0xFFFD;
inline constexpr std::uint32_t no_plant = 0xFFFFFFFF;

// One rendered picture with what it shows. Only `colour` is always there; the others are empty unless asked for.
// Of several samples a pixel, the AOVs keep the one that is nearest to the pixel's centre.
struct Frame {
  Image colour;  // 3 channels: radiance, scaled so that a white sheet facing the noon sun is about 1
  Image depth;   // 1 channel: metres from the eye along the ray; infinity where the sky is seen
  Image normal;  // 3 channels: of the surface, towards the eye, in world space; zero in the sky
  std::vector<std::uint16_t> species;  // row by row: index over the species of all layers, one after another
  std::vector<std::uint32_t> plants;   // row by row: index over the sites of all layers (docs/pictures.md)
};

}  // namespace silvavis::image
