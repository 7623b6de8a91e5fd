#include "assets/texture.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "assets/picture_rows.h"
#include "assets/resample.h"
#include "assets/srgb.h"
#include "silvasim/base/words.h"

namespace assets {

namespace {

constexpr int strip_rows = 64;

struct Size {
  int width, height;
  friend bool operator==(const Size&, const Size&) = default;
};

Size reduced(Size size, int most) {
  const int longer = std::max(size.width, size.height);
  if (longer <= most) return size;
  const auto side = [&](int s) {
    return std::max(1, static_cast<int>(std::lround(static_cast<double>(s) * most / longer)));
  };
  return {side(size.width), side(size.height)};
}

template <typename F>
void for_each_row(PictureRows& picture, F&& use) {
  std::vector<std::uint8_t> strip;
  const auto row_bytes = static_cast<std::size_t>(picture.width()) * 4;
  for (int y = 0; y < picture.height(); y += strip_rows) {
    const int end = std::min(y + strip_rows, picture.height());
    picture.read(y, end, strip);
    for (int k = y; k < end; ++k) use(strip.data() + static_cast<std::size_t>(k - y) * row_bytes);
  }
}

std::uint8_t to_byte(float share) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(share, 0.0f, 1.0f) * 255.0f));
}

bool seen(std::uint8_t alpha, float cutoff) { return static_cast<float>(alpha) >= cutoff * 255.0f; }

// Alpha bytes of a size, with the share that the picture had. A byte at the cutoff must not fall below it by rounding.
std::vector<std::uint8_t> alpha_bytes(std::vector<float> alphas, float cutoff, double share) {
  keep_coverage(alphas, cutoff, share);
  std::vector<std::uint8_t> bytes(alphas.size());
  const auto least = static_cast<int>(std::ceil(cutoff * 255.0f));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const int byte = to_byte(alphas[i]);
    bytes[i] =
        static_cast<std::uint8_t>(alphas[i] >= cutoff ? std::max(byte, least) : std::min(byte, std::max(0, least - 1)));
  }
  return bytes;
}

// The colour's texels at `size`; with `weighted` also its alpha.
void read_colour(PictureRows& picture, Size size, bool weighted, float cutoff, Texture& texture) {
  const auto width = static_cast<std::size_t>(picture.width());
  const std::size_t texels = texture.rgba.size() / 4;
  if (Size{picture.width(), picture.height()} == size) {
    auto out = texture.rgba.begin();
    for_each_row(picture, [&](const std::uint8_t* row) { out = std::copy(row, row + width * 4, out); });
    if (!weighted) {
      for (std::size_t i = 0; i < texels; ++i) texture.rgba[4 * i + 3] = 255;
    }
    return;
  }
  // Colours count by their alpha, and a little where there is none, so that a picture that is all invisible keeps them.
  constexpr std::size_t channels = 5;
  constexpr float little = 1e-4f;
  const std::array<float, 256>& linear = linear_of_bytes();
  Resampler resampler(picture.width(), picture.height(), size.width, size.height, static_cast<int>(channels));
  std::vector<float> floats(width * channels);
  std::size_t covered = 0;
  for_each_row(picture, [&](const std::uint8_t* row) {
    for (std::size_t x = 0; x < width; ++x) {
      const std::uint8_t* p = row + 4 * x;
      const float alpha = weighted ? static_cast<float>(p[3]) / 255.0f : 1.0f;
      const float weight = alpha + little;
      float* f = floats.data() + channels * x;
      for (int c = 0; c < 3; ++c) f[c] = linear[p[c]] * weight;
      f[3] = weight;
      f[4] = alpha;
      if (weighted && seen(p[3], cutoff)) ++covered;
    }
    resampler.add_row(floats);
  });
  const std::vector<float>& result = resampler.pixels();
  std::vector<float> alphas(texels);
  for (std::size_t i = 0; i < texels; ++i) {
    const float* f = result.data() + channels * i;
    const float weight = std::max(f[3], little);
    for (std::size_t c = 0; c < 3; ++c) texture.rgba[4 * i + c] = byte_of_linear(f[c] / weight);
    alphas[i] = f[4];
  }
  if (!weighted) return;
  const double share = static_cast<double>(covered) / (static_cast<double>(width) * picture.height());
  const std::vector<std::uint8_t> bytes = alpha_bytes(std::move(alphas), cutoff, share);
  for (std::size_t i = 0; i < texels; ++i) texture.rgba[4 * i + 3] = bytes[i];
}

// Alpha from a picture of its own: its alpha, or its brightness.
void read_alpha(PictureRows& picture, Size size, float cutoff, Texture& texture) {
  const auto width = static_cast<std::size_t>(picture.width());
  const std::size_t texels = texture.rgba.size() / 4;
  const bool own = picture.has_alpha();
  const auto alpha_of = [own](const std::uint8_t* p) {
    return own ? p[3] : static_cast<std::uint8_t>((54 * p[0] + 183 * p[1] + 19 * p[2]) / 256);
  };
  if (Size{picture.width(), picture.height()} == size) {
    std::size_t i = 0;
    for_each_row(picture, [&](const std::uint8_t* row) {
      for (std::size_t x = 0; x < width; ++x) texture.rgba[4 * i++ + 3] = alpha_of(row + 4 * x);
    });
    return;
  }
  Resampler resampler(picture.width(), picture.height(), size.width, size.height, 1);
  std::vector<float> floats(width);
  std::size_t covered = 0;
  for_each_row(picture, [&](const std::uint8_t* row) {
    for (std::size_t x = 0; x < width; ++x) {
      const std::uint8_t alpha = alpha_of(row + 4 * x);
      floats[x] = static_cast<float>(alpha) / 255.0f;
      if (seen(alpha, cutoff)) ++covered;
    }
    resampler.add_row(floats);
  });
  const double share = static_cast<double>(covered) / (static_cast<double>(width) * picture.height());
  const std::vector<std::uint8_t> bytes = alpha_bytes(resampler.pixels(), cutoff, share);
  for (std::size_t i = 0; i < texels; ++i) texture.rgba[4 * i + 3] = bytes[i];
}

// Gives texels that are hardly seen the colour of what is seen around them, coarse levels first (pull-push, Gortler et al.
// 1996), so that no interpolation draws a black rim around a leaf.
void bleed_colours(Texture& texture) {
  struct Level {
    int width, height;
    std::vector<V3> sum;
    std::vector<float> weight;
  };
  constexpr std::uint8_t hardly = 16;
  const std::array<float, 256>& linear = linear_of_bytes();
  std::vector<Level> levels;
  const auto texels = static_cast<std::size_t>(texture.width) * static_cast<std::size_t>(texture.height);
  levels.push_back({texture.width, texture.height, std::vector<V3>(texels), std::vector<float>(texels)});
  for (std::size_t i = 0; i < texels; ++i) {
    const std::uint8_t* p = texture.rgba.data() + 4 * i;
    const float weight = p[3] < hardly ? 0.0f : static_cast<float>(p[3]);
    levels[0].sum[i] = V3(linear[p[0]], linear[p[1]], linear[p[2]]) * weight;
    levels[0].weight[i] = weight;
  }
  while (levels.back().width > 1 || levels.back().height > 1) {
    const Level& fine = levels.back();
    Level coarse{(fine.width + 1) / 2, (fine.height + 1) / 2, {}, {}};
    const auto count = static_cast<std::size_t>(coarse.width) * static_cast<std::size_t>(coarse.height);
    coarse.sum.assign(count, V3(0.0f, 0.0f, 0.0f));
    coarse.weight.assign(count, 0.0f);
    for (int y = 0; y < fine.height; ++y) {
      for (int x = 0; x < fine.width; ++x) {
        const auto from =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(fine.width) + static_cast<std::size_t>(x);
        const auto to =
            static_cast<std::size_t>(y / 2) * static_cast<std::size_t>(coarse.width) + static_cast<std::size_t>(x / 2);
        coarse.sum[to] += fine.sum[from];
        coarse.weight[to] += fine.weight[from];
      }
    }
    levels.push_back(std::move(coarse));
  }
  if (levels.back().weight[0] <= 0) return;
  for (std::size_t l = levels.size() - 1; l-- > 0;) {
    Level& fine = levels[l];
    const Level& coarse = levels[l + 1];
    for (int y = 0; y < fine.height; ++y) {
      for (int x = 0; x < fine.width; ++x) {
        const auto to =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(fine.width) + static_cast<std::size_t>(x);
        if (fine.weight[to] > 0) continue;
        const auto from =
            static_cast<std::size_t>(y / 2) * static_cast<std::size_t>(coarse.width) + static_cast<std::size_t>(x / 2);
        fine.sum[to] = coarse.sum[from] / coarse.weight[from];
        fine.weight[to] = 1;
      }
    }
  }
  for (std::size_t i = 0; i < texels; ++i) {
    std::uint8_t* p = texture.rgba.data() + 4 * i;
    if (p[3] >= hardly) continue;
    for (int c = 0; c < 3; ++c) p[c] = byte_of_linear(levels[0].sum[i][c]);
  }
}

}  // namespace

Texture load_texture(const Picture& colour, const Picture* alpha, const TextureOptions& options) {
  PictureRows colour_rows(colour);
  std::optional<PictureRows> alpha_rows;
  if (alpha != nullptr && options.alpha_cutoff > 0) alpha_rows.emplace(*alpha);

  // The size of the larger picture, where there are two.
  Size size{colour_rows.width(), colour_rows.height()};
  if (alpha_rows) size = {std::max(size.width, alpha_rows->width()), std::max(size.height, alpha_rows->height())};
  size = reduced(size, std::max(1, options.most_px));

  Texture texture;
  texture.name = silvasim::base::shortened(colour.name, 200);
  texture.width = size.width;
  texture.height = size.height;
  texture.rgba.assign(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) * 4, 255);
  const bool weighted = options.alpha_cutoff > 0 && !alpha_rows && colour_rows.has_alpha();
  read_colour(colour_rows, size, weighted, options.alpha_cutoff, texture);
  if (alpha_rows) read_alpha(*alpha_rows, size, options.alpha_cutoff, texture);

  for (std::size_t i = 3; i < texture.rgba.size() && !texture.has_alpha; i += 4)
    texture.has_alpha = texture.rgba[i] < 255;
  if (texture.has_alpha) bleed_colours(texture);
  return texture;
}

double coverage(const Texture& texture, float cutoff) {
  std::size_t covered = 0;
  for (std::size_t i = 3; i < texture.rgba.size(); i += 4) {
    if (seen(texture.rgba[i], cutoff)) ++covered;
  }
  return texture.rgba.empty() ? 0 : static_cast<double>(covered) / (static_cast<double>(texture.rgba.size()) / 4);
}

Rgb mean_colour(const Texture& texture, float cutoff) {
  const std::array<float, 256>& linear = linear_of_bytes();
  V3d sum(0.0, 0.0, 0.0);
  std::size_t count = 0;
  for (std::size_t i = 0; i + 3 < texture.rgba.size(); i += 4) {
    if (!seen(texture.rgba[i + 3], cutoff)) continue;
    sum += V3d(linear[texture.rgba[i]], linear[texture.rgba[i + 1]], linear[texture.rgba[i + 2]]);
    ++count;
  }
  if (count == 0) return {0.5f, 0.5f, 0.5f};
  sum /= static_cast<double>(count);
  return {static_cast<float>(sum.x), static_cast<float>(sum.y), static_cast<float>(sum.z)};
}

}  // namespace assets
