#include "silvavis/commands/detail_files.h"

#include <algorithm>
#include <cmath>

#include "ghosttile/config/scene.h"
#include "ghosttile/fill/fill.h"
#include "silvasim/base/error.h"

namespace silvavis::commands {

namespace density = ghosttile::density;
namespace fill = ghosttile::fill;

namespace {

density::Box3 box_around(const V3d& eye, double radius_m) {
  density::Box3 box = ghosttile::config::everywhere();
  box.least.x = eye.x - radius_m;
  box.least.y = eye.y - radius_m;
  box.most.x = eye.x + radius_m;
  box.most.y = eye.y + radius_m;
  return box;
}

density::Box3 region_of(const ghosttile::config::Scene& scene, const std::vector<V3d>& eyes, double radius_m) {
  density::Box3 region = ghosttile::config::everywhere();
  if (eyes.empty()) {
    const silvasim::base::Box& land = scene.land();
    if (land.empty()) return region;
    region.least.x = land.west;
    region.least.y = land.south;
    region.most.x = land.east;
    region.most.y = land.north;
    return region;
  }
  region = box_around(eyes[0], radius_m);
  for (const V3d& eye : eyes) {
    const density::Box3 box = box_around(eye, radius_m);
    region.least.x = std::min(region.least.x, box.least.x);
    region.least.y = std::min(region.least.y, box.least.y);
    region.most.x = std::max(region.most.x, box.most.x);
    region.most.y = std::max(region.most.y, box.most.y);
  }
  return region;
}

}  // namespace

fill::DetailsFile details_of(const std::filesystem::path& file, const std::vector<V3d>& eyes, double radius_m,
                             const silvasim::base::Progress& progress) {
  if (file.extension() != ".xml") return fill::read(file);
  const ghosttile::config::Scene scene(file, progress);
  const density::Box3 region = region_of(scene, eyes, radius_m);
  const fill::Plan plan = scene.plan(region);
  fill::DetailsFile filled;
  filled.tile = scene.tile();
  filled.crs_wkt = scene.crs_wkt();
  filled.details.first.push_back(0);
  if (eyes.empty()) {
    filled.details = fill::fill(plan, fill::tiles_within(plan, region), progress);
    return filled;
  }
  // Square by square, each wide enough for the eyes that are near this one.
  const V3d* last = nullptr;
  for (const V3d& eye : eyes) {
    if (last && std::hypot(eye.x - last->x, eye.y - last->y) < radius_m / 4) continue;
    last = &eye;
    const fill::TileBox box = fill::tiles_within(plan, box_around(eye, 1.25 * radius_m));
    filled.details = fill::joined(filled.details, fill::fill(plan, box, progress), box);
  }
  return filled;
}

silvasim::ecosystem::Ecosystem land_under(const fill::DetailsFile& details) {
  constexpr double margin_m = 10;
  if (details.details.tiles.empty()) throw silvasim::base::Error("there are no details to see");
  silvasim::ecosystem::Ecosystem land;
  land.crs_wkt = details.crs_wkt;
  const auto side = static_cast<double>(details.tile->side_m);
  for (const fill::TilePlace& tile : details.details.tiles) {
    land.extent.west = std::min(land.extent.west, tile.x * side - margin_m);
    land.extent.south = std::min(land.extent.south, tile.y * side - margin_m);
    land.extent.east = std::max(land.extent.east, (tile.x + 1) * side + margin_m);
    land.extent.north = std::max(land.extent.north, (tile.y + 1) * side + margin_m);
  }
  return land;
}

}  // namespace silvavis::commands
