#include "ghosttile/fill/details.h"

namespace ghosttile::fill {

namespace {

void append_tile(const Details& from, std::size_t tile, Details& to) {
  to.tiles.push_back(from.tiles[tile]);
  to.instances.push_back(from.instances[tile]);
  to.chosen.insert(to.chosen.end(), from.chosen.begin() + from.first[tile], from.chosen.begin() + from.first[tile + 1]);
  to.first.push_back(static_cast<std::uint32_t>(to.chosen.size()));
}

}  // namespace

Details part_of(const Details& details, const TileBox& box) {
  Details part;
  part.first.push_back(0);
  for (std::size_t t = 0; t < details.tiles.size(); ++t)
    if (box.holds(details.tiles[t].x, details.tiles[t].y, details.tiles[t].z)) append_tile(details, t, part);
  return part;
}

Details joined(const Details& outside, const Details& inside, const TileBox& box) {
  Details all;
  all.first.push_back(0);
  std::size_t a = 0, b = 0;
  const auto skip = [&] {
    while (a < outside.tiles.size() && box.holds(outside.tiles[a].x, outside.tiles[a].y, outside.tiles[a].z)) ++a;
  };
  for (skip(); a < outside.tiles.size() || b < inside.tiles.size(); skip()) {
    if (b == inside.tiles.size() || (a < outside.tiles.size() && outside.tiles[a] < inside.tiles[b])) {
      append_tile(outside, a++, all);
    } else {
      append_tile(inside, b++, all);
    }
  }
  return all;
}

}  // namespace ghosttile::fill
