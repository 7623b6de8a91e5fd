#include "silvavis/pixel_sequence.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace silvavis {

namespace {

std::uint64_t mixed(std::uint64_t h) {  // the finaliser of murmur3
  h = (h ^ (h >> 33)) * 0xFF51AFD7ED558CCDu;
  h = (h ^ (h >> 33)) * 0xC4CEB9FE1A85EC53u;
  return h ^ (h >> 33);
}

std::uint64_t spread(std::uint32_t v) {  // bits apart, for one of two coordinates
  std::uint64_t x = v;
  x = (x | x << 16) & 0x0000FFFF0000FFFFu;
  x = (x | x << 8) & 0x00FF00FF00FF00FFu;
  x = (x | x << 4) & 0x0F0F0F0F0F0F0F0Fu;
  x = (x | x << 2) & 0x3333333333333333u;
  return (x | x << 1) & 0x5555555555555555u;
}

// The digit of four in one of the 24 orders, which the digits above it choose.
std::uint64_t shuffled_digit(std::uint64_t digit, std::uint64_t above, std::uint32_t seed) {
  // Draw without putting back: first place, second, third.
  std::uint64_t h = mixed(above * 0x9E3779B97F4A7C15u + seed) % 24;
  std::array<std::uint8_t, 4> order{0, 1, 2, 3};
  for (std::uint64_t left = 4; left > 1; --left) {
    std::swap(order[left - 1], order[h % left]);
    h /= left;
  }
  return order[digit];
}

std::uint32_t reversed(std::uint32_t x) {
  x = x << 16 | x >> 16;
  x = (x & 0x00FF00FFu) << 8 | (x & 0xFF00FF00u) >> 8;
  x = (x & 0x0F0F0F0Fu) << 4 | (x & 0xF0F0F0F0u) >> 4;
  x = (x & 0x33333333u) << 2 | (x & 0xCCCCCCCCu) >> 2;
  return (x & 0x55555555u) << 1 | (x & 0xAAAAAAAAu) >> 1;
}

// Sobol's second dimension: the matrix of Pascal's triangle modulo 2.
std::uint32_t second_of(std::uint32_t index) {
  std::uint32_t result = 0;
  for (std::uint32_t column = 1u << 31; index != 0; index >>= 1, column ^= column >> 1)
    if (index & 1) result ^= column;
  return result;
}

// Each bit is flipped by a hash of those above it.
float scrambled(std::uint32_t bits, std::uint32_t seed) {
  std::uint32_t x = reversed(bits);
  x ^= x * 0x3D20ADEAu;
  x += seed;
  x *= (seed >> 16) | 1;
  x ^= x * 0x05526C56u;
  x ^= x * 0x53A22864u;
  return static_cast<float>(reversed(x) >> 8) * 0x1p-24f;
}

std::uint64_t along_curve(int x, int y) {
  return spread(static_cast<std::uint32_t>(x)) | spread(static_cast<std::uint32_t>(y)) << 1;
}

}  // namespace

PixelSequence::PixelSequence(std::uint64_t seed, int x, int y, int most_samples) : pixel_(along_curve(x, y)) {
  while ((std::int64_t{1} << (2 * digits_)) < most_samples) ++digits_;
  for (std::size_t k = 0; k < pairs; ++k)
    of_[k].seed = static_cast<std::uint32_t>(mixed(seed * 0xD1B54A32D192ED03u + k + 1));
  shuffle_from(15 - digits_);
}

void PixelSequence::move_to(int x, int y) {
  const std::uint64_t to = along_curve(x, y), other = pixel_ ^ to;
  pixel_ = to;
  // Digits above the first that is another stay as they are.
  if (other != 0) shuffle_from(std::min(15 - digits_, (static_cast<int>(std::bit_width(other)) - 1) / 2));
}

// Anew from this digit of the pixel's index down.
void PixelSequence::shuffle_from(int highest) {
  for (Pair& pair : of_) {
    // 32 bits of index are left for the sequence: pictures of up to 2^32 samples, and larger ones repeat.
    pair.index &= ~std::uint64_t{0} << (2 * (highest + 1));
    for (int digit = highest; digit >= 0; --digit) {
      const std::uint64_t above = pixel_ >> (2 * digit + 2);
      pair.index |=
          shuffled_digit(pixel_ >> (2 * digit) & 3, above << 5 | static_cast<std::uint64_t>(digit + digits_), pair.seed)
          << (2 * digit);
    }
    const auto high = static_cast<std::uint32_t>(pair.index << (2 * digits_));
    pair.first = reversed(high);
    pair.second = second_of(high);
  }
}

std::array<float, 2> PixelSequence::at(std::size_t pair_number, int number) const {
  const Pair& pair = of_[pair_number];
  const auto n = static_cast<std::uint64_t>(number);
  std::uint64_t low = 0;
  for (int digit = digits_ - 1; digit >= 0; --digit) {
    const std::uint64_t above =
        pixel_ << (2 * (digits_ - digit - 1)) | (n & ((std::uint64_t{1} << (2 * digits_)) - 1)) >> (2 * digit + 2);
    low |= shuffled_digit(n >> (2 * digit) & 3, above << 5 | static_cast<std::uint64_t>(digit), pair.seed)
           << (2 * digit);
  }
  const auto index = static_cast<std::uint32_t>(low);
  return {scrambled(pair.first ^ reversed(index), pair.seed), scrambled(pair.second ^ second_of(index), ~pair.seed)};
}

}  // namespace silvavis
