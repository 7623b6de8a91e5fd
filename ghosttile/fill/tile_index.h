// Numbers for the tiles that are worked on: column by column, each from its lowest to its highest tile.
#pragma once

#include <cstdint>
#include <vector>

#include "ghosttile/fill/details.h"
#include "ghosttile/fill/plan.h"

namespace ghosttile::fill {

inline constexpr std::uint32_t no_slot = 0xFFFFFFFFu;

class TileIndex {
 public:
  TileIndex() = default;
  // `places`: sorted, none twice. Tiles between a column's first and last get a slot too.
  explicit TileIndex(const std::vector<TilePlace>& places);

  std::uint32_t slot(int x, int y, int z) const {
    if (x < box_.x0 || x >= box_.x1 || y < box_.y0 || y >= box_.y1) return no_slot;
    const std::uint32_t patch = patches_[patch_of(x, y)];
    if (patch == no_slot) return no_slot;
    const Column& column =
        columns_[patch * patch_side * patch_side + within(y - box_.y0) * patch_side + within(x - box_.x0)];
    const auto up = static_cast<std::uint32_t>(z - column.z0);
    return up < column.count ? column.first + up : no_slot;
  }
  const TilePlace& place(std::uint32_t slot) const { return places_[slot]; }
  std::uint32_t size() const { return static_cast<std::uint32_t>(places_.size()); }
  const TileBox& box() const { return box_; }

 private:
  // Columns stand in patches, so that a few tiles in a wide land cost little.
  static constexpr std::uint32_t patch_side = 16;
  struct Column {
    std::int32_t z0 = 0;
    std::uint32_t count = 0, first = 0;
  };
  static std::uint32_t within(int from_edge) { return static_cast<std::uint32_t>(from_edge) % patch_side; }
  std::size_t patch_of(int x, int y) const {
    return static_cast<std::uint32_t>(y - box_.y0) / patch_side * patch_columns_ +
           static_cast<std::uint32_t>(x - box_.x0) / patch_side;
  }

  TileBox box_;  // of the places
  std::size_t patch_columns_ = 0;
  std::vector<std::uint32_t> patches_;
  std::vector<Column> columns_;
  std::vector<TilePlace> places_;  // by slot
};

}  // namespace ghosttile::fill
