// A Ghost Tile from its XML: models read or made, spheres fitted, anchors set, candidates spread.
//
// Errors: base::ConfigError with every finding in the XML; base::Error for a model that cannot be read or used.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "ghosttile/tile/create.h"

namespace ghosttile::config {

struct TileXml {
  tile::CreateOptions options;
  std::vector<objects::Detail> objects;
  std::vector<std::filesystem::path> inputs;  // all files that were read
  std::vector<std::string> warnings;
};
TileXml load_tile_xml(const std::filesystem::path& file);

// A Ghost Tile by its XML or its own file, as the extension says.
struct LoadedTile {
  tile::GhostTile tile;
  std::vector<std::filesystem::path> inputs;
  std::vector<std::string> warnings;
};
LoadedTile load_tile(const std::filesystem::path& file, const silvasim::base::Progress& progress = {});

}  // namespace ghosttile::config
