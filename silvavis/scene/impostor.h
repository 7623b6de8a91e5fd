// A plant from far away: for some directions a grid of what rays met when they were traced through the full model.
//
// A texel holds how much of it the plant covers; four of them share four of the very points that were met: a leaf or a piece of wood
// of the full model, with its normal and colours, and the 128 directions of the upper hemisphere in which the plant itself bars the light. So
// coverage, colour and own shadow are the full model's in the mean, at the price of looking into a table instead of walking a
// tree. What bars the light is found out where it is first asked for (shade/own_shadow.h): a picture asks for a small part of it.
// The grid turns with who looks, about the stem, so nothing pops where an eye moves around a plant; between elevations
// and at the edge of coverage a hash of ray and plant decides, so nothing pops there either.
//
// Units: metres of the model's space. A grid is as wide as the upright cylinder that holds the model, seen in its direction.
// Memory: 1.1 MB a model. Made by silvavis/impostor_of.h.
// Source: Silva 2013, section 5 (impostors for a preview of 10 Hz).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "silvavis/base/vector.h"

namespace silvavis::scene {

struct Impostor {
  // Grids: of rays that travel down or up by so many degrees, even in the sine, and from so many sides.
  static constexpr int elevations = 12, sides = 3;
  static constexpr int lamp_bands = 8, lamp_azimuths = 16, lamps = lamp_bands * lamp_azimuths;
  static constexpr std::uint32_t points_a_block = 4;

  struct Point {
    // By lamp: the plant itself is in the light's way. Only for shade/own_shadow.h
    mutable std::array<std::uint64_t, lamps / 64> barred{};
    mutable std::uint32_t known = 0;  // by lamp / 4: the bits in `barred` are right
    std::uint32_t slot = 0;           // triangle of the full model
    float depth_m = 0;                // along the direction, from the plane through the foot
    std::uint16_t u = 0, v = 0;       // weights of corners 1 and 2, of 65535

    float weight_1() const { return static_cast<float>(u) * (1.0f / 65535); }
    float weight_2() const { return static_cast<float>(v) * (1.0f / 65535); }
  };

  float radius_m = 1, least_m = 0, most_m = 1;
  float texel_m = 1;                              // side of a texel
  std::uint32_t columns = 2;                      // even, as rows are: four texels are a block
  std::array<std::uint32_t, elevations> rows{};   // of a grid
  std::array<std::uint32_t, elevations> first{};  // texel of the elevation's first side, its south-western in its grid
  std::vector<std::uint8_t> covered;              // by texel, of 255
  std::vector<Point> points;                      // points_a_block by block; meaningless where nothing is covered

  std::size_t bytes() const { return covered.size() + points.size() * sizeof(Point); }
};

// How the model's cylinder looks in a direction: across is to the right, up is upward, both in metres from the foot.
struct ImpostorView {
  float ahead_x, ahead_y;  // the direction's way over the ground, of unit length
  float level, sine;       // its share along that way, and upward
  float bottom_m, top_m;

  ImpostorView(const Impostor& impostor, const V3& direction)
      : level(std::sqrt(direction.x * direction.x + direction.y * direction.y)), sine(direction.z) {
    const bool upright = level < 1e-6f;
    ahead_x = upright ? 1.0f : direction.x / level;
    ahead_y = upright ? 0.0f : direction.y / level;
    const float beside = impostor.radius_m * std::abs(sine);
    bottom_m = impostor.least_m * level - beside;
    top_m = impostor.most_m * level + beside;
  }
  float across_m(const V3& at) const { return at.x * ahead_y - at.y * ahead_x; }
  float up_m(const V3& at) const { return at.z * level - (at.x * ahead_x + at.y * ahead_y) * sine; }
  V3 point(float across, float up) const {
    return {ahead_y * across - ahead_x * sine * up, -ahead_x * across - ahead_y * sine * up, level * up};
  }
};

// The direction of a grid, and that towards a lamp of the upper hemisphere.
V3 impostor_direction(int elevation, int side);
V3 lamp_direction(std::uint32_t lamp);

// A direction's place around the axis in [0, 4), without a call of a trigonometric function: 0 is +x, 1 is +y. Multiples of a
// half are multiples of 45 degrees.
inline float diamond_angle(float x, float y) {
  const float sum = std::abs(x) + std::abs(y);
  if (sum <= 0) return 0;
  const float part = y / sum;
  if (x >= 0) return y >= 0 ? part : 4 + part;
  return 2 - part;
}

// A well mixed number for what chance decides between a ray and a plant.
inline std::uint64_t mixed(std::uint64_t h) {
  h = (h ^ (h >> 32)) * 0xD6E8FEB86659FD93u;
  h = (h ^ (h >> 32)) * 0xD6E8FEB86659FD93u;
  return h ^ (h >> 32);
}
inline std::uint64_t ray_hash(const V3d& origin, const V3& direction) {
  const auto bits = [](double v) { return std::bit_cast<std::uint64_t>(v); };
  const auto word = [](float v) { return std::uint64_t{std::bit_cast<std::uint32_t>(v)}; };
  std::uint64_t h = mixed(bits(origin.x) + 0x9E3779B97F4A7C15u * bits(origin.y));
  h ^= word(direction.x) << 32 | word(direction.y);
  return mixed(h + 0x9E3779B97F4A7C15u * word(direction.z));
}
inline float of_byte(std::uint64_t chance, int from) {
  return static_cast<float>(chance >> from & 0xFF) * (1.0f / 256);
}

inline constexpr std::uint32_t no_point = 0xFFFFFFFFu;

// The point that a ray meets, or no_point. `origin`: the point of the ray nearest to the foot; `direction`: of unit length;
// `side`: the plant's own, below Impostor::sides; `chance`: mixed bits of ray and plant.
inline std::uint32_t meet_impostor(const Impostor& impostor, const V3& origin, const V3& direction, std::uint32_t side,
                                   std::uint64_t chance) {
  const ImpostorView view(impostor, direction);
  const float across = view.across_m(origin) / impostor.radius_m;
  if (!(std::abs(across) < 1)) return no_point;
  const float rise = (view.up_m(origin) - view.bottom_m) / (view.top_m - view.bottom_m);
  if (!(rise >= 0 && rise < 1)) return no_point;
  const float place = (direction.z + 1) * (0.5f * Impostor::elevations) + 0.5f + of_byte(chance, 0);
  const auto elevation = static_cast<std::size_t>(std::clamp(static_cast<int>(place) - 1, 0, Impostor::elevations - 1));
  const std::uint32_t rows = impostor.rows[elevation];
  // Between texels too: a picture's pixels may be a little finer than they are.
  const auto among = [](float at, std::uint32_t count) {
    return static_cast<std::uint32_t>(std::clamp(at, 0.0f, static_cast<float>(count) - 0.5f));
  };
  const std::uint32_t column =
      among((across + 1) * 0.5f * static_cast<float>(impostor.columns) + of_byte(chance, 32) - 0.5f, impostor.columns);
  const std::uint32_t row = among(rise * static_cast<float>(rows) + of_byte(chance, 40) - 0.5f, rows);
  const std::uint32_t texel = impostor.first[elevation] + (side * rows + row) * impostor.columns + column;
  if ((chance >> 16 & 0xFFFF) * 255 >= std::uint64_t{impostor.covered[texel]} << 16) return no_point;
  const std::uint32_t block =
      impostor.first[elevation] / 4 + (side * rows / 2 + row / 2) * (impostor.columns / 2) + column / 2;
  return block * Impostor::points_a_block + static_cast<std::uint32_t>(chance >> 48 & (Impostor::points_a_block - 1));
}

// The lamp for a light, `towards` in the model's space and above the horizon. Between lamps chance decides.
inline std::uint32_t lamp_for(const V3& towards, std::uint64_t chance) {
  const float place = towards.z * Impostor::lamp_bands + 0.5f + of_byte(chance, 0);
  const int band = std::clamp(static_cast<int>(place) - 1, 0, Impostor::lamp_bands - 1);
  const int azimuth =
      static_cast<int>((Impostor::lamp_azimuths / 4) * diamond_angle(towards.x, towards.y) + of_byte(chance, 8)) &
      (Impostor::lamp_azimuths - 1);
  return static_cast<std::uint32_t>(azimuth * Impostor::lamp_bands + band);
}

}  // namespace silvavis::scene
