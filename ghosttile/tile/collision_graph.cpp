#include "ghosttile/tile/collision_graph.h"

#include <algorithm>

namespace ghosttile::tile {

bool CollisionGraph::collides(std::uint32_t i, std::uint32_t j, const Offset& v) const {
  for (const int along : v)
    if (along < -reach || along > reach) return false;
  const auto place = static_cast<std::uint16_t>(offset_index(v) * words_a_tile() + j / 64);
  const auto first = places.begin() + first_word[i], last = places.begin() + first_word[i + 1];
  const auto found = std::lower_bound(first, last, place);
  if (found == last || *found != place) return false;
  return bits[static_cast<std::size_t>(found - places.begin())] >> (j % 64) & 1;
}

std::string CollisionGraph::problem() const {
  const std::uint64_t places_of_all =
      std::uint64_t{words_a_tile()} * static_cast<std::uint64_t>(side() * side() * side());
  if (first_word.size() != std::size_t{candidates} + 1 || first_word.front() != 0 ||
      first_word.back() != places.size() || places.size() != bits.size())
    return "its columns do not fit each other";
  if (places_of_all > 65536) return "it has more candidates than it can name";
  for (std::uint32_t i = 0; i < candidates; ++i) {
    if (first_word[i] > first_word[i + 1] || first_word[i + 1] > places.size())
      return "the words of a candidate end before they begin";
    for (std::uint32_t w = first_word[i]; w < first_word[i + 1]; ++w) {
      if (places[w] >= places_of_all || bits[w] == 0 || (w > first_word[i] && places[w] <= places[w - 1]))
        return "a word has no place, no bit, or stands out of order";
      const std::uint32_t last_j =
          places[w] % words_a_tile() * 64 + 63 - static_cast<std::uint32_t>(std::countl_zero(bits[w]));
      if (last_j >= candidates) return "an arc leads to a candidate that is none";
    }
  }
  for (std::uint32_t i = 0; i < candidates; ++i) {
    for (std::uint32_t w = first_word[i]; w < first_word[i + 1]; ++w) {
      const Offset v = offset(places[w] / words_a_tile());
      for (std::uint64_t left = bits[w]; left != 0; left &= left - 1) {
        const std::uint32_t j = places[w] % words_a_tile() * 64 + static_cast<std::uint32_t>(std::countr_zero(left));
        if (i == j && v == Offset{0, 0, 0}) return "a candidate collides with itself";
        if (!collides(j, i, {-v[0], -v[1], -v[2]})) return "an arc has none that leads back";
      }
    }
  }
  return {};
}

}  // namespace ghosttile::tile
