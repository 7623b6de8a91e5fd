// What filling yields: which candidates of the Ghost Tile stand in which tile. Two bytes an instance, and its tile's.
//
// Promise: tiles are sorted by y, x, z, each once; a tile's candidates increase; no two instances collide by the graph.
// Refused ones were chosen and then left out to keep to a density below 1: they still bar the place, so that a later edit
//   finds it as it was. They are no instances.
// Source: Guérin et al. 2016, section 3 ("instances are represented as a list of indexes").
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ghosttile/fill/tile_box.h"

namespace ghosttile::fill {

struct Details {
  std::vector<TilePlace> tiles;
  std::vector<std::uint32_t> first;      // by tile, and the end: into `chosen`
  std::vector<std::uint16_t> chosen;     // candidates; the instances of a tile, then its refused ones
  std::vector<std::uint16_t> instances;  // by tile: how many of `chosen` are instances

  std::span<const std::uint16_t> of(std::size_t tile) const { return {chosen.data() + first[tile], instances[tile]}; }
  std::span<const std::uint16_t> refused_of(std::size_t tile) const {
    return {chosen.data() + first[tile] + instances[tile], first[tile + 1] - first[tile] - instances[tile]};
  }
  std::uint64_t count() const {
    std::uint64_t sum = 0;
    for (const std::uint16_t n : instances) sum += n;
    return sum;
  }
  std::size_t bytes() const {
    return tiles.size() * sizeof(TilePlace) + first.size() * sizeof(first[0]) + chosen.size() * sizeof(chosen[0]) +
           instances.size() * sizeof(instances[0]);
  }

  friend bool operator==(const Details&, const Details&) = default;
};

// The tiles within the box.
Details part_of(const Details& details, const TileBox& box);

// Outside of the box the first's tiles, inside the second's, which has none outside.
Details joined(const Details& outside, const Details& inside, const TileBox& box);

}  // namespace ghosttile::fill
