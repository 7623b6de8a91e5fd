#include "silvavis/assets/grown/canvas.h"

#include <algorithm>
#include <array>

namespace silvavis::assets::grown {

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

void spread_colours(Canvas& canvas) {
  for (int ring = 0; ring < 8; ++ring) {
    const std::vector<Texel> before = canvas.texels;
    const auto old = [&](int x, int y) -> const Texel& {
      return before[static_cast<std::size_t>(y) * static_cast<std::size_t>(canvas.width) + static_cast<std::size_t>(x)];
    };
    const auto blank = [](const Texel& t) { return t.alpha <= 0 && t.colour.x + t.colour.y + t.colour.z <= 0; };
    for (int y = 0; y < canvas.height; ++y) {
      for (int x = 0; x < canvas.width; ++x) {
        if (!blank(old(x, y))) continue;
        Rgb sum(0, 0, 0);
        float count = 0;
        for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
          const int i = x + dx, j = y + dy;
          if (i < 0 || j < 0 || i >= canvas.width || j >= canvas.height || blank(old(i, j))) continue;
          sum += old(i, j).colour;
          count += 1;
        }
        if (count > 0) canvas.at(x, y).colour = sum * (1 / count);
      }
    }
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
  texture.rgba.reserve(canvas.texels.size() * 4);
  for (const Texel& t : canvas.texels) {
    const std::uint8_t alpha = has_alpha ? static_cast<std::uint8_t>(clamp01(t.alpha) * 255 + 0.5f) : 255;
    texture.rgba.insert(texture.rgba.end(),
                        {encoded_fast(t.colour.x), encoded_fast(t.colour.y), encoded_fast(t.colour.z), alpha});
  }
  return texture;
}

float tiling_noise(float x, float y, int period_x, int period_y, std::uint32_t salt) {
  const auto corner = [&](int i, int j) {
    const auto a = static_cast<std::uint32_t>((i % period_x + period_x) % period_x);
    const auto b = static_cast<std::uint32_t>((j % period_y + period_y) % period_y);
    std::uint32_t h = (a * 0x9E3779B1u) ^ (b * 0x85EBCA77u) ^ (salt * 0xC2B2AE3Du);
    h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
    h = (h ^ (h >> 12)) * 0x297A2D39u;
    return static_cast<float>((h ^ (h >> 15)) >> 8) * 0x1p-23f - 1;
  };
  const float fx = std::floor(x), fy = std::floor(y);
  const int i = static_cast<int>(fx), j = static_cast<int>(fy);
  const float u = smooth(0, 1, x - fx), v = smooth(0, 1, y - fy);
  return mix(mix(corner(i, j), corner(i + 1, j), u), mix(corner(i, j + 1), corner(i + 1, j + 1), u), v);
}

}  // namespace silvavis::assets::grown
