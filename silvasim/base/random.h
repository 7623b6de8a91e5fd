// Counter-based random numbers: a draw is a pure function of a key (what it is for, and where), never of the draws
// before it, so that any thread may make it and neighbours of a place never change it.
//
// Source: Philox 4x32-10 (Salmon et al. 2011), by the Random123 library.
#pragma once

#include <array>
#include <cstdint>

namespace silvasim::base {

// What a stream of numbers is for. Append only: the values are part of what a seed means.
enum class Purpose : std::uint32_t {
  tile_discs = 1,
  tiling = 2,
  selection = 3,
  establishment = 4,
  neighbourhood = 5,
  rotation = 6,
  plant_form = 7,
  picture = 8,
  impostor = 9,
  detail_surface = 20,
  detail_anchor = 21,
  detail_form = 22,
  density_warp = 23,
  cover = 24,
  candidate = 30,
  scatter = 31,
};

// A stream of numbers named by (seed, purpose, a, b, c). Two streams with different names are independent.
class Stream {
 public:
  Stream(std::uint64_t seed, Purpose purpose, std::uint32_t a = 0, std::uint32_t b = 0, std::uint32_t c = 0)
      : key_{static_cast<std::uint32_t>(seed),
             static_cast<std::uint32_t>(seed >> 32) ^ (static_cast<std::uint32_t>(purpose) * 0x9E3779B9u)},
        counter_{a, b, c, 0} {}

  std::uint32_t next_u32() {
    if (left_ == 0) refill();
    return block_[--left_];
  }

  // Uniform in [0,1), a multiple of 2^-24: exact in float and in double.
  float next_float() { return static_cast<float>(next_u32() >> 8) * 0x1p-24f; }

  // Uniform in [0,1), a multiple of 2^-53.
  double next_double() {
    const std::uint64_t high = next_u32() >> 5, low = next_u32() >> 6;
    return static_cast<double>((high << 26) | low) * 0x1p-53;
  }

  // Uniform in [0, bound), without bias (Lemire 2019). bound > 0.
  std::uint32_t next_below(std::uint32_t bound);

 private:
  void refill();

  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 4> counter_;
  std::array<std::uint32_t, 4> block_{};
  int left_ = 0;
};

// The one draw at a place: the first number of its stream, in [0,1).
inline float uniform_at(std::uint64_t seed, Purpose purpose, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  return Stream(seed, purpose, a, b, c).next_float();
}

}  // namespace silvasim::base
