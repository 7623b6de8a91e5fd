#include "ghosttile/fill/plan.h"

#include <algorithm>
#include <cmath>

namespace ghosttile::fill {

namespace {

int tile_at(double metres, double side_m) {
  const double tile = std::floor(metres / side_m);
  return static_cast<int>(std::clamp(tile, -1.0 * farthest_tile, 1.0 * farthest_tile));
}

}  // namespace

TileBox tiles_within(const Plan& plan, const density::Box3& box) {
  const auto side = static_cast<double>(plan.tile->side_m);
  if (!(box.least.x <= box.most.x && box.least.y <= box.most.y && box.least.z <= box.most.z)) return {};
  return {tile_at(box.least.x, side),    tile_at(box.least.y, side),    tile_at(box.least.z, side),
          tile_at(box.most.x, side) + 1, tile_at(box.most.y, side) + 1, tile_at(box.most.z, side) + 1};
}

TileBox tiles_of(const Plan& plan) {
  // An anchor within the field may belong to a candidate whose origin lies in the tile beside.
  const auto reach = static_cast<double>(tile::reach_of(*plan.tile));
  TileBox all;
  for (const ObjectRule& rule : plan.objects) {
    density::Box3 box = rule.density.bounds();
    box.least -= V3d(reach, reach, reach);
    box.most += V3d(reach, reach, reach);
    const TileBox tiles = tiles_within(plan, box);
    if (tiles.empty()) continue;
    all = all.empty() ? tiles
                      : TileBox{std::min(all.x0, tiles.x0), std::min(all.y0, tiles.y0), std::min(all.z0, tiles.z0),
                                std::max(all.x1, tiles.x1), std::max(all.y1, tiles.y1), std::max(all.z1, tiles.z1)};
  }
  return all;
}

}  // namespace ghosttile::fill
