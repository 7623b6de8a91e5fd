// ghosttile edit: strokes on details, and back again.
#include "ghosttile/fill/edit.h"

#include <fmt/format.h>

#include "ghosttile/commands/commands.h"
#include "ghosttile/commands/console.h"
#include "ghosttile/config/scene.h"
#include "ghosttile/fill/fill.h"
#include "silvasim/base/error.h"
#include "silvasim/base/file.h"
#include "silvasim/base/parallel.h"
#include "silvasim/config/xml.h"

namespace ghosttile::commands {

namespace {

using silvasim::base::Error;

Path scene_of(const EditOptions& options, const fill::DetailsFile& file) {
  if (options.scene) return *options.scene;
  if (file.scene.empty())
    throw Error(options.details.string() + ": it names no scene; name the one it was filled from by --scene");
  const Path scene = options.details.parent_path() / file.scene;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(scene, ignored))
    throw Error(options.details.string() + ": the scene that it was filled from, \"" + scene.string() +
                "\", is not there; name it by --scene");
  return scene;
}

// Returns the tiles that were filled anew.
fill::TileBox stroke(const EditOptions& options, fill::DetailsFile& file, std::vector<Path>& inputs,
                     const silvasim::base::Progress& progress) {
  const std::string strokes = silvasim::base::read_file(*options.strokes, silvasim::config::most_config_bytes);
  const Path scene_file = scene_of(options, file);
  config::Scene scene(scene_file, progress);
  inputs = scene.inputs();
  inputs.push_back(*options.strokes);
  if (scene.sha256() != file.scene_sha256)
    throw Error(scene_file.string() + ": it, or a file that it names, has changed since " + options.details.string() +
                " was filled; fill it again");
  // The very tile that the details were filled with, also where this program would make another one of its XML.
  scene.use_tile(file.tile);
  const density::Box3 box = scene.touched_by(strokes, options.strokes->string());
  std::vector<std::string> edits;
  for (const fill::Edit& edit : file.edits) edits.push_back(edit.strokes_xml);
  edits.push_back(strokes);
  const auto reach = static_cast<double>(tile::reach_of(*file.tile) + density::gradient_step_m);
  const density::Box3 around{box.least - density::V3d(reach, reach, reach),
                             box.most + density::V3d(reach, reach, reach)};
  const fill::Plan plan = scene.plan(around, edits);
  const fill::TileBox touched = fill::intersection(fill::tiles_within(plan, around), file.filled);
  if (touched.empty()) throw Error(options.strokes->string() + ": all strokes lie outside of what was filled");
  fill::edit(plan, file, touched, strokes, progress);
  return file.edits.back().touched;
}

}  // namespace

void edit(const EditOptions& options) {
  if (options.undo == options.strokes.has_value())
    silvasim::terminal::wrong_option("give a file of strokes, or --undo for the last edit");
  const silvasim::base::ThreadLimit threads(options.common.threads);
  const silvasim::base::Progress progress = silvasim::terminal::console_progress(options.common);
  fill::DetailsFile file = fill::read(options.details);
  const std::uint64_t before = file.details.count();
  fill::TileBox touched;
  std::vector<Path> inputs;
  if (options.undo) {
    if (file.edits.empty()) throw Error(options.details.string() + ": there is no edit to undo");
    touched = file.edits.back().touched;
    fill::undo(file);
    // What an edit keeps is only looked at here: a damaged one must not be written on.
    fill::from_bytes(fill::to_bytes(file), options.details.string());
  } else {
    touched = stroke(options, file, inputs, progress);
  }
  const Path output = options.output.value_or(options.details);
  if (!file.scene.empty()) {
    std::error_code ignored;
    const Path from = std::filesystem::absolute(options.details, ignored).parent_path(),
               to = std::filesystem::absolute(output, ignored).parent_path();
    file.scene = std::filesystem::relative(from / file.scene, to, ignored).generic_string();
  }
  fill::write(file, output, inputs);
  silvasim::terminal::end_progress(options.common);
  const std::uint64_t tiles = touched.empty() ? 0
                                              : static_cast<std::uint64_t>(touched.x1 - touched.x0) *
                                                    static_cast<std::uint64_t>(touched.y1 - touched.y0) *
                                                    static_cast<std::uint64_t>(touched.z1 - touched.z0);
  if (options.common.json) {
    Json json = details_json(*file.tile, file.details);
    json["instances_before"] = before;
    json["tiles_touched"] = tiles;
    json["edits"] = file.edits.size();
    json["output"] = output.string();
    fmt::print("{}\n", json.dump(2));
  } else if (!options.common.quiet) {
    fmt::print("{} instances before, {} after; {} tiles filled anew, {} edit{} in all\n",
               silvasim::terminal::grouped(before), silvasim::terminal::grouped(file.details.count()),
               silvasim::terminal::grouped(tiles), file.edits.size(), file.edits.size() == 1 ? "" : "s");
  }
}

}  // namespace ghosttile::commands
