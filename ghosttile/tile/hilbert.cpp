#include "ghosttile/tile/hilbert.h"

#include <algorithm>
#include <array>

namespace ghosttile::tile {

std::uint32_t hilbert_place(const assets::V3& share) {
  constexpr int bits = 10;
  std::array<std::uint32_t, 3> x{};
  for (int axis = 0; axis < 3; ++axis)
    x[static_cast<std::size_t>(axis)] =
        static_cast<std::uint32_t>(std::clamp(share[axis], 0.0f, 0.9999f) * (1 << bits));

  // Undo the excess turns, from the largest cube to the smallest.
  for (std::uint32_t q = 1u << (bits - 1); q > 1; q >>= 1) {
    const std::uint32_t below = q - 1;
    for (std::uint32_t& axis : x) {
      if (axis & q) {
        x[0] ^= below;
      } else {
        const std::uint32_t swapped = (x[0] ^ axis) & below;
        x[0] ^= swapped;
        axis ^= swapped;
      }
    }
  }
  // Gray code.
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t turn = 0;
  for (std::uint32_t q = 1u << (bits - 1); q > 1; q >>= 1)
    if (x[2] & q) turn ^= q - 1;
  for (std::uint32_t& axis : x) axis ^= turn;

  std::uint32_t place = 0;
  for (int bit = bits - 1; bit >= 0; --bit)
    for (const std::uint32_t axis : x) place = place << 1 | (axis >> bit & 1);
  return place;
}

}  // namespace ghosttile::tile
