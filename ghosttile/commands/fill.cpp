// ghosttile fill: details over the land that a scene names.
#include "ghosttile/fill/fill.h"

#include <fmt/format.h>

#include <system_error>

#include "ghosttile/commands/commands.h"
#include "ghosttile/commands/console.h"
#include "ghosttile/config/scene.h"
#include "ghosttile/fill/file.h"
#include "silvasim/base/error.h"
#include "silvasim/base/parallel.h"

namespace ghosttile::commands {

namespace {

using silvasim::terminal::wrong_option;

// What was asked for: the options' box, or the land of the scene's ecosystem, or all that its fields bound.
density::Box3 region_of(const FillOptions& options, const config::Scene& scene) {
  density::Box3 region = config::everywhere();
  const auto cut_to = [&](double west, double south, double east, double north) {
    region.least.x = west;
    region.least.y = south;
    region.most.x = east;
    region.most.y = north;
  };
  if (!options.bbox.empty()) {
    if (options.bbox[0] >= options.bbox[2] || options.bbox[1] >= options.bbox[3])
      wrong_option("--bbox: WEST should be below EAST, and SOUTH below NORTH");
    cut_to(options.bbox[0], options.bbox[1], options.bbox[2], options.bbox[3]);
  } else if (!options.around.empty()) {
    const double x = options.around[0], y = options.around[1], r = options.radius_m;
    cut_to(x - r, y - r, x + r, y + r);
  } else if (!scene.land().empty()) {
    cut_to(scene.land().west, scene.land().south, scene.land().east, scene.land().north);
  }
  return region;
}

}  // namespace

void fill(const FillOptions& options) {
  if (!options.bbox.empty() && !options.around.empty())
    wrong_option("--bbox and --around say the same thing twice; give one of them");
  const silvasim::base::ThreadLimit threads(options.common.threads);
  const silvasim::base::Progress progress = silvasim::terminal::console_progress(options.common);
  const config::Scene scene(options.scene, progress);
  const density::Box3 region = region_of(options, scene);
  const fill::Plan plan = scene.plan(region);
  fill::DetailsFile file;
  file.tile = scene.tile();
  file.filled = fill::tiles_within(plan, region);
  fill::FillCounts counts;
  file.details = fill::fill(plan, file.filled, progress, &counts);
  const Path output = options.output.value_or(options.scene.stem().string() + ".details");
  std::error_code ignored;
  const Path beside = std::filesystem::absolute(output, ignored).parent_path();
  file.scene =
      std::filesystem::relative(std::filesystem::absolute(options.scene, ignored), beside, ignored).generic_string();
  file.scene_sha256 = scene.sha256();
  file.crs_wkt = scene.crs_wkt();
  fill::write(file, output, scene.inputs());
  silvasim::terminal::end_progress(options.common);
  print_warnings(scene.warnings(), options.common);
  if (options.common.json) {
    Json json = details_json(*file.tile, file.details);
    json["candidates"] = counts.candidates;
    json["candidates_looked_at"] = counts.looked_at;
    json["candidates_possible"] = counts.possible;
    json["output"] = output.string();
    fmt::print("{}\n", json.dump(2));
  } else if (!options.common.quiet) {
    print_details(*file.tile, file.details);
    fmt::print("written to {}\n", output.string());
  }
}

}  // namespace ghosttile::commands
