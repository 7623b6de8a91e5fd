// ghosttile create: a Ghost Tile from its XML.
#include <fmt/format.h>

#include "ghosttile/commands/commands.h"
#include "ghosttile/commands/console.h"
#include "ghosttile/config/tile_xml.h"
#include "ghosttile/tile/file.h"
#include "silvasim/base/parallel.h"

namespace ghosttile::commands {

void create(const CreateOptions& options) {
  const silvasim::base::ThreadLimit threads(options.common.threads);
  const silvasim::base::Progress progress = silvasim::terminal::console_progress(options.common);
  config::TileXml loaded = config::load_tile_xml(options.tile);
  const Path output = options.output.value_or(options.tile.stem().string() + ".ghost");
  tile::CreateCounts counts;
  const tile::GhostTile tile = tile::create(std::move(loaded.objects), loaded.options, progress, &counts);
  tile::write(tile, output, loaded.inputs);
  silvasim::terminal::end_progress(options.common);
  print_warnings(loaded.warnings, options.common);
  if (options.common.json) {
    Json json = tile_json(tile);
    json["pairs_looked_at"] = counts.looked_at;
    json["output"] = output.string();
    fmt::print("{}\n", json.dump(2));
  } else if (!options.common.quiet) {
    print_tile(tile);
    fmt::print("written to {}\n", output.string());
  }
}

}  // namespace ghosttile::commands
