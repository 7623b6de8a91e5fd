// The Ghost Tile's file (`.ghost`): objects with their models, spheres and anchors, candidates, collision graph.
//
// Promise: read(write(t)) is t; what is read is safe to work with, whatever the bytes were: indices in range, numbers finite, the graph
//   symmetric. That the graph is complete is taken on trust: it is not worked out again.
// Errors: base::Error naming the file, the chunk, the byte, and what is wrong.
// docs/ghost-tiles.md describes the chunks.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "ghosttile/tile/chunk_list.h"
#include "ghosttile/tile/ghost_tile.h"

namespace ghosttile::tile {

inline constexpr ChunkType tile_type{'G', 'H', 'S', 'T'};  // the first of a file

void write(const GhostTile& tile, const std::filesystem::path& path,
           std::span<const std::filesystem::path> inputs = {});
GhostTile read(const std::filesystem::path& path);

// The chunks alone, which files of details hold too.
std::vector<NamedChunk> chunks_of(const GhostTile& tile);
GhostTile tile_from(const std::vector<NamedChunk>& chunks, const std::string& name);

}  // namespace ghosttile::tile
