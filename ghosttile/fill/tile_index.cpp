#include "ghosttile/fill/tile_index.h"

#include <algorithm>

namespace ghosttile::fill {

TileIndex::TileIndex(const std::vector<TilePlace>& places) {
  if (places.empty()) return;
  box_ = {places[0].x, places[0].y, places[0].z, places[0].x + 1, places[0].y + 1, places[0].z + 1};
  for (const TilePlace& place : places) {
    box_.x0 = std::min(box_.x0, place.x);
    box_.x1 = std::max(box_.x1, place.x + 1);
    box_.y1 = std::max(box_.y1, place.y + 1);
    box_.z0 = std::min(box_.z0, place.z);
    box_.z1 = std::max(box_.z1, place.z + 1);
  }
  const auto patches_along = [](int from, int to) { return static_cast<std::size_t>(to - from - 1) / patch_side + 1; };
  patch_columns_ = patches_along(box_.x0, box_.x1);
  patches_.assign(patch_columns_ * patches_along(box_.y0, box_.y1), no_slot);
  for (std::size_t p = 0; p < places.size();) {
    const auto [x, y, lowest] = places[p];
    std::size_t next = p + 1;
    while (next < places.size() && places[next].x == x && places[next].y == y) ++next;
    std::uint32_t& patch = patches_[patch_of(x, y)];
    if (patch == no_slot) {
      patch = static_cast<std::uint32_t>(columns_.size() / (patch_side * patch_side));
      columns_.resize(columns_.size() + patch_side * patch_side);
    }
    const int highest = places[next - 1].z;
    columns_[patch * patch_side * patch_side + within(y - box_.y0) * patch_side + within(x - box_.x0)] = {
        lowest, static_cast<std::uint32_t>(highest - lowest + 1), static_cast<std::uint32_t>(places_.size())};
    for (int z = lowest; z <= highest; ++z) places_.push_back({x, y, z});
    p = next;
  }
}

}  // namespace ghosttile::fill
