// Selection and propagation: candidates get their turn, those that are still possible are chosen, and what collides with them is possible no
// longer.
//
// The order is known beforehand (survivors.h): stage by stage; within a stage colour by colour, tiles of one colour so far apart that
//   none touches what another does; within a tile by chance. So the result is that of going through all candidates one
//   by one, whatever the threads: no two collide, and nothing that could be placed is left.
// Where land goes on beyond what is filled, a candidate that may be barred from there is doubtful, and so is what it may bar in
//   turn. Tiles without a doubtful turn hold exactly what they hold in a fill of any larger land.
// Source: Guérin et al. 2016, section 5.3, figure 16; docs/ghost-tiles.md, E5.
#pragma once

#include <cstdint>
#include <vector>

#include "ghosttile/fill/survivors.h"

namespace ghosttile::fill {

struct Selection {
  std::vector<std::uint64_t> chosen;   // by slot, as Survivors::alive
  std::vector<std::uint8_t> doubtful;  // by slot: not settled; empty where nothing was unknown
};

// Takes from `survivors.alive` what collides with a candidate of a tile, which need not have a slot.
void bar(const tile::CollisionGraph& graph, const TilePlace& tile, std::uint32_t candidate, const TileIndex& index,
         std::uint32_t words, std::uint64_t* bits);

// `unknown(place)`: whether a tile without a slot may hold something; null: none does. Uses up survivors.alive.
struct SelectOptions {
  std::uint64_t seed = 0;
  bool (*unknown)(const void* context, const TilePlace& place) = nullptr;
  const void* context = nullptr;
};
Selection select(const tile::GhostTile& tile, Survivors& survivors, const SelectOptions& options,
                 const silvasim::base::Progress& progress = {});

}  // namespace ghosttile::fill
