// What ghosttile's commands share in telling their results.
#pragma once

#include <nlohmann/json.hpp>

#include "ghosttile/fill/details.h"
#include "ghosttile/tile/ghost_tile.h"
#include "silvasim/terminal/terminal.h"

namespace ghosttile::commands {

using Json = nlohmann::ordered_json;

Json tile_json(const tile::GhostTile& tile);
void print_tile(const tile::GhostTile& tile);

// How many instances of each object.
std::vector<std::uint64_t> instances_by_object(const tile::GhostTile& tile, const fill::Details& details);
Json details_json(const tile::GhostTile& tile, const fill::Details& details);
void print_details(const tile::GhostTile& tile, const fill::Details& details);

void print_warnings(const std::vector<std::string>& warnings, const silvasim::terminal::Common& common);

}  // namespace ghosttile::commands
