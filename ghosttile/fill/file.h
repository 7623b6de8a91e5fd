// The file of details (`.details`): the Ghost Tile, what stands where, what it was filled from, and the edits since.
//
// Promise: read(write(d)) is d; what is read keeps the promises of its parts: tiles sorted, candidates in range, none that
//   collide. Two bytes an instance before compression, and its tile's.
// Errors: base::Error naming the file, the chunk, the byte, and what is wrong.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ghosttile/fill/details.h"
#include "ghosttile/tile/file.h"

namespace ghosttile::fill {

inline constexpr tile::ChunkType details_type{'D', 'E', 'T', 'L'};  // the first of a file

// What an edit did: its strokes, and what stood in the tiles that it filled anew, so that it can be undone.
struct Edit {
  std::string strokes_xml;
  TileBox touched;
  Details before;  // of the touched tiles

  friend bool operator==(const Edit&, const Edit&) = default;
};
inline constexpr std::size_t most_edits = 100'000;

struct DetailsFile {
  std::shared_ptr<const tile::GhostTile> tile;
  Details details;
  std::string scene;         // path of the scene's XML, relative to the file of details where that is possible
  std::string scene_sha256;  // of its text and of all that it names
  std::string crs_wkt;       // of the scene's coordinates; empty: local metres
  TileBox filled;
  std::vector<Edit> edits;
};

void write(const DetailsFile& file, const std::filesystem::path& path,
           std::span<const std::filesystem::path> inputs = {});
DetailsFile read(const std::filesystem::path& path);

std::vector<std::byte> to_bytes(const DetailsFile& file);
DetailsFile from_bytes(std::span<const std::byte> bytes, const std::string& name);

}  // namespace ghosttile::fill
