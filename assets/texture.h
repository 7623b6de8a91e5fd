// Pictures of leaves and bark, from files or from bytes inside a model file, as textures of model.h.
//
// Formats: PNG, JPEG, Targa, BMP, TIFF, told by their first bytes.
// Promise: longer sides are resampled to `most_px` (Mitchell-Netravali, in linear light, weighted by alpha, so that what is
//   invisible lends no colour). With a cutoff, the share of texels with alpha >= cutoff stays what it was in the file,
//   within one texel: leaves neither thin out nor swell. Same bytes on every machine.
// Errors: base::Error naming the picture. Its size is checked before a pixel is read.
// Threads: may be called from several at once; files are read through one cache of OpenImageIO for all models.
// Cost: a picture is read in strips; memory is that of the result and some strips.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "assets/model.h"

namespace assets {

inline constexpr int most_picture_side_px = 16384;
inline constexpr long long most_picture_px = 64ll << 20;

struct Picture {
  std::string name;              // for messages
  std::filesystem::path file;    // empty: `bytes` are the picture
  std::vector<std::byte> bytes;  // empty too: one white pixel
};

struct TextureOptions {
  int most_px = 1024;
  float alpha_cutoff = 0;  // 0: alpha is dropped
};

// `alpha`: a second picture whose alpha (its brightness where it has none) is taken; null: the first one's own.
Texture load_texture(const Picture& colour, const Picture* alpha, const TextureOptions& options);

// Share of the texels with alpha >= cutoff.
double coverage(const Texture& texture, float cutoff);

// Mean colour in linear light of the texels with alpha >= cutoff; grey where there are none.
Rgb mean_colour(const Texture& texture, float cutoff);

}  // namespace assets
