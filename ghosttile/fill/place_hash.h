// Chance by place: numbers that depend on the seed, the tile and the candidate alone.
#pragma once

#include <cstdint>

#include "ghosttile/fill/details.h"

namespace ghosttile::fill {

// The finaliser of murmur3: every bit of what goes in changes every bit of what comes out.
inline std::uint64_t mixed(std::uint64_t h) {
  h = (h ^ (h >> 33)) * 0xFF51AFD7ED558CCDu;
  h = (h ^ (h >> 33)) * 0xC4CEB9FE1A85EC53u;
  return h ^ (h >> 33);
}
inline std::uint64_t tile_hash(std::uint64_t seed, const TilePlace& tile) {
  const std::uint64_t plane =
      static_cast<std::uint64_t>(static_cast<std::uint32_t>(tile.x)) << 32 | static_cast<std::uint32_t>(tile.y);
  return mixed(mixed(seed * 0x9E3779B97F4A7C15u + plane) + static_cast<std::uint32_t>(tile.z));
}
// The upper half decides the order of candidates, the lower whether one is refused.
inline std::uint64_t candidate_hash(std::uint64_t tile, std::uint32_t candidate) {
  return mixed(tile + 0xD6E8FEB86659FD93u * (candidate + 1));
}

}  // namespace ghosttile::fill
