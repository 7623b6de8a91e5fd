#include "assets/grown/canvas.h"

#include <algorithm>
#include <array>

namespace assets::grown {

std::uint8_t encoded(float linear) {
  const float x = clamp01(linear);
  const float s = x <= 0.0031308f ? 12.92f * x : 1.055f * power(x, 1 / 2.4f) - 0.055f;
  return static_cast<std::uint8_t>(s * 255 + 0.5f);
}

namespace {

// The encoding by a table: power() for each texel would cost more than painting.
std::uint8_t encoded_fast(float linear) {
  static const auto table = [] {
    std::array<std::uint8_t, 4096> t{};
    for (std::size_t i = 0; i < t.size(); ++i) {
      const float root = (static_cast<float>(i) + 0.5f) / static_cast<float>(t.size());
      t[i] = encoded(root * root);
    }
    return t;
  }();
  return table[std::min<std::size_t>(4095, static_cast<std::size_t>(std::sqrt(clamp01(linear)) * 4096))];
}

// Ring by ring: a blank texel becomes the mean of those beside it that the ring before has coloured.
void spread_colours(Canvas& canvas) {
  const int width = canvas.width, height = canvas.height;
  const auto blank = [](const Texel& t) { return t.alpha <= 0 && t.colour.x + t.colour.y + t.colour.z <= 0; };
  std::vector<std::uint8_t> coloured(canvas.texels.size());
  std::vector<std::uint32_t> blanks, still;
  for (std::uint32_t i = 0; i < canvas.texels.size(); ++i) {
    coloured[i] = !blank(canvas.texels[i]);
    if (!coloured[i]) blanks.push_back(i);
  }
  std::vector<std::uint32_t> ring;
  for (int rings = 0; rings < 8; ++rings) {
    ring.clear();
    still.clear();
    for (const std::uint32_t i : blanks) {
      const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
      Rgb sum(0, 0, 0);
      float count = 0;
      const auto add = [&](bool there, std::uint32_t beside) {
        if (!there || !coloured[beside]) return;
        sum += canvas.texels[beside].colour;
        count += 1;
      };
      add(x > 0, i - 1);
      add(x + 1 < width, i + 1);
      add(y > 0, i - static_cast<std::uint32_t>(width));
      add(y + 1 < height, i + static_cast<std::uint32_t>(width));
      if (count <= 0) {
        still.push_back(i);
        continue;
      }
      canvas.texels[i].colour = sum * (1 / count);
      (blank(canvas.texels[i]) ? still : ring).push_back(i);
    }
    for (const std::uint32_t i : ring) coloured[i] = 1;
    blanks.swap(still);
  }
}

}  // namespace

Texture to_texture(Canvas canvas, const std::string& name, bool has_alpha) {
  if (has_alpha) spread_colours(canvas);
  Texture texture;
  texture.name = name;
  texture.width = canvas.width;
  texture.height = canvas.height;
  texture.has_alpha = has_alpha;
  texture.rgba.resize(canvas.texels.size() * 4);
  std::uint8_t* to = texture.rgba.data();
  for (const Texel& t : canvas.texels) {
    *to++ = encoded_fast(t.colour.x);
    *to++ = encoded_fast(t.colour.y);
    *to++ = encoded_fast(t.colour.z);
    *to++ = has_alpha ? static_cast<std::uint8_t>(clamp01(t.alpha) * 255 + 0.5f) : 255;
  }
  return texture;
}

float tiling_noise(float x, float y, int period_x, int period_y, std::uint32_t salt) {
  const auto column = [](int i, int period) {  // few are outside, and a division costs more than all the rest
    if (i >= 0 && i < period) return static_cast<std::uint32_t>(i);
    return static_cast<std::uint32_t>(i == period ? 0 : (i % period + period) % period);
  };
  const auto value = [](std::uint32_t h) {
    h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
    h = (h ^ (h >> 12)) * 0x297A2D39u;
    return static_cast<float>((h ^ (h >> 15)) >> 8) * 0x1p-23f - 1;
  };
  const auto floored = [](float at) { return static_cast<int>(at) - (at < static_cast<float>(static_cast<int>(at))); };
  const int i = floored(x), j = floored(y);
  const float u = smooth(0, 1, x - static_cast<float>(i)), v = smooth(0, 1, y - static_cast<float>(j));
  const std::uint32_t salted = salt * 0xC2B2AE3Du;
  const std::uint32_t a0 = column(i, period_x) * 0x9E3779B1u, a1 = column(i + 1, period_x) * 0x9E3779B1u;
  const std::uint32_t b0 = column(j, period_y) * 0x85EBCA77u ^ salted,
                      b1 = column(j + 1, period_y) * 0x85EBCA77u ^ salted;
  return mix(mix(value(a0 ^ b0), value(a1 ^ b0), u), mix(value(a0 ^ b1), value(a1 ^ b1), u), v);
}

}  // namespace assets::grown
