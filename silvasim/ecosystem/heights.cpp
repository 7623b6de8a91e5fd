#include "silvasim/ecosystem/heights.h"

#include <bit>
#include <cassert>
#include <cstdint>

namespace silvasim::ecosystem {

namespace {

// From the heights before number i, in rows of `columns`.
std::uint32_t predicted(std::span<const float> heights_m, std::size_t columns, std::size_t i) {
  const auto bits = [&](std::size_t at) { return std::bit_cast<std::uint32_t>(heights_m[at]); };
  const bool west = i % columns != 0, north = i >= columns;
  if (west && north) return bits(i - 1) + bits(i - columns) - bits(i - columns - 1);
  if (west) return bits(i - 1);
  return north ? bits(i - columns) : 0;
}

}  // namespace

std::vector<std::byte> bytes_from_heights(std::span<const float> heights_m, std::size_t columns) {
  const std::size_t count = heights_m.size();
  std::vector<std::byte> bytes(4 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t d = std::bit_cast<std::uint32_t>(heights_m[i]) - predicted(heights_m, columns, i);
    const std::uint32_t folded = (d << 1) ^ (d >> 31 ? ~std::uint32_t{0} : 0);
    for (std::size_t plane = 0; plane < 4; ++plane)
      bytes[plane * count + i] = static_cast<std::byte>(folded >> 8 * plane);
  }
  return bytes;
}

void heights_from_bytes(std::span<const std::byte> bytes, std::size_t columns, std::span<float> heights_m) {
  const std::size_t count = heights_m.size();
  assert(bytes.size() == 4 * count);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t folded = 0;
    for (std::size_t plane = 0; plane < 4; ++plane) {
      folded |= std::to_integer<std::uint32_t>(bytes[plane * count + i]) << 8 * plane;
    }
    const std::uint32_t d = (folded >> 1) ^ (folded & 1 ? ~std::uint32_t{0} : 0);
    heights_m[i] = std::bit_cast<float>(predicted(heights_m, columns, i) + d);
  }
}

}  // namespace silvasim::ecosystem
