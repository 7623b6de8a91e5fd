// Which candidates of a Ghost Tile collide: arcs (i, j, v), candidate i of a tile with candidate j of the tile that lies v tiles away.
//
// Shape: for each i, 64 candidates j of one offset v at a time as a word of bits, words without a bit left out. Candidates that
//   collide have near indices, so words are full: about a byte an arc, and a candidate's whole neighbourhood is taken away
//   from those that are still possible with a few dozen operations.
// Promise: symmetric: with (i, j, v) there is (j, i, -v). Holds the arcs of a candidate with itself in other tiles, (i, i, v != 0),
//   never (i, i, 0). Complete: offsets reach as far as the candidates do.
// Source: Guérin et al. 2016, section 4.1; docs/reading.md, E1 and E3.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace ghosttile::tile {

using Offset = std::array<int, 3>;  // in tiles

struct CollisionGraph {
  std::uint32_t candidates = 0;
  int reach = 1;  // offsets are within [-reach, reach]^3

  // Words of candidate i are [first_word[i], first_word[i + 1]), in increasing place. A word's place is
  // offset index * words_a_tile() + j / 64.
  std::vector<std::uint32_t> first_word;
  std::vector<std::uint16_t> places;  // by word
  std::vector<std::uint64_t> bits;    // by word

  std::uint32_t words_a_tile() const { return (candidates + 63) / 64; }
  int side() const { return 2 * reach + 1; }
  // x fastest; the tile itself is the middle one.
  Offset offset(std::uint32_t index) const {
    const auto n = static_cast<std::uint32_t>(side());
    return {static_cast<int>(index % n) - reach, static_cast<int>(index / n % n) - reach,
            static_cast<int>(index / (n * n)) - reach};
  }
  std::uint32_t offset_index(const Offset& v) const {
    return static_cast<std::uint32_t>(((v[2] + reach) * side() + v[1] + reach) * side() + v[0] + reach);
  }

  // The paper's #E: arcs, each pair counted twice.
  std::uint64_t arcs() const {
    std::uint64_t sum = 0;
    for (const std::uint64_t word : bits) sum += static_cast<std::uint64_t>(std::popcount(word));
    return sum;
  }
  bool collides(std::uint32_t i, std::uint32_t j, const Offset& v) const;
  // Whether it keeps the promises above, for graphs from files; what is wrong in words, or empty.
  std::string problem() const;
  std::size_t bytes() const {
    return first_word.size() * sizeof(first_word[0]) + places.size() * sizeof(places[0]) +
           bits.size() * sizeof(bits[0]);
  }

  friend bool operator==(const CollisionGraph&, const CollisionGraph&) = default;
};

}  // namespace ghosttile::tile
