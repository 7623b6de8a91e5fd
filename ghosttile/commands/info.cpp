// ghosttile info: what a Ghost Tile or a file of details holds.
#include <fmt/format.h>

#include "ghosttile/commands/commands.h"
#include "ghosttile/commands/console.h"
#include "ghosttile/fill/file.h"

namespace ghosttile::commands {

void info(const InfoOptions& options) {
  if (options.file.extension() == ".ghost") {
    const tile::GhostTile tile = tile::read(options.file);
    if (options.common.json) {
      fmt::print("{}\n", tile_json(tile).dump(2));
    } else {
      print_tile(tile);
    }
    return;
  }
  const fill::DetailsFile file = fill::read(options.file);
  if (options.common.json) {
    Json json = details_json(*file.tile, file.details);
    json["scene"] = file.scene;
    json["edits"] = file.edits.size();
    json["tile"] = tile_json(*file.tile);
    fmt::print("{}\n", json.dump(2));
    return;
  }
  print_details(*file.tile, file.details);
  fmt::print("filled from {}, {} edit{} since\n", file.scene.empty() ? "no scene" : file.scene, file.edits.size(),
             file.edits.size() == 1 ? "" : "s");
  print_tile(*file.tile);
}

}  // namespace ghosttile::commands
