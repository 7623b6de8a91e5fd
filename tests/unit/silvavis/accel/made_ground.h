// Ground detail for tests: a Ghost Tile of leaf balls and quads in all turns, and instances of it over the land of a made forest.
#pragma once

#include <cmath>
#include <vector>

#include "ghosttile/tile/frames.h"
#include "made_forest.h"
#include "silvasim/base/random.h"
#include "silvavis/accel/pack.h"
#include "silvavis/scene/details.h"

namespace silvavis::testing {

inline ghosttile::tile::GhostTile made_tile(std::uint32_t candidates, float side_m = 0.5f) {
  ghosttile::tile::GhostTile tile;
  tile.side_m = side_m;
  for (const bool holes : {true, false}) {
    ghosttile::objects::Detail detail;
    detail.name = holes ? "holed ball" : "flat thing";
    detail.model = leaf_ball(holes ? 40 : 6, 0.12, holes ? 0.05 : 0.09, holes, 3);
    tile.objects.push_back(std::move(detail));
  }
  ghosttile::tile::Spread spread;
  spread.least_scale = 0.5f;
  spread.most_scale = 1.5f;
  for (std::uint32_t c = 0; c < candidates; ++c)
    tile.candidates.push_back(
        ghosttile::tile::random_frame(7, static_cast<std::uint16_t>(c % 2), c, spread, tile.side_m));
  return tile;
}

struct MadeGround {
  double west = -20, south = -20, east = 20, north = 20;  // world space
  std::uint32_t candidates = 300;
  double share = 0.1;  // of a tile's candidates
  std::uint64_t seed = 3;
};

// In the tiles through which the land goes; every third tile has refused ones too, which do not stand.
inline ghosttile::fill::Details made_details(const scene::Scene& scene, const ghosttile::tile::GhostTile& tile,
                                             const MadeGround& made) {
  silvasim::base::Stream random(made.seed, silvasim::base::Purpose::rotation, 5);
  const auto side = static_cast<double>(tile.side_m);
  const auto at = [&](double world, double origin) { return static_cast<int>(std::floor((world + origin) / side)); };
  ghosttile::fill::Details details;
  details.first.push_back(0);
  for (int y = at(made.south, scene.origin.y); y < at(made.north, scene.origin.y); ++y) {
    for (int x = at(made.west, scene.origin.x); x < at(made.east, scene.origin.x); ++x) {
      if (random.next_below(5) == 0) continue;  // gaps
      const double height =
          scene::ground_at(scene.ground, (x + 0.5) * side - scene.origin.x, (y + 0.5) * side - scene.origin.y).height_m;
      const int z = static_cast<int>(std::floor(height / side));
      for (int up = 0; up < 1 + static_cast<int>(random.next_below(3)); ++up) {
        details.tiles.push_back({x, y, z + up});
        std::uint16_t instances = 0;
        for (std::size_t c = 0; c < tile.candidates.size(); ++c) {
          if (random.next_double() >= made.share) continue;
          details.chosen.push_back(static_cast<std::uint16_t>(c));
          ++instances;
        }
        details.instances.push_back(instances);
        if (details.tiles.size() % 3 == 0) details.chosen.insert(details.chosen.end(), {0, 1});
        details.first.push_back(static_cast<std::uint32_t>(details.chosen.size()));
      }
    }
  }
  return details;
}

inline scene::DetailKind kind_in(scene::Scene& scene, const ghosttile::tile::GhostTile& tile) {
  std::vector<std::uint32_t> models;
  for (const auto& object : tile.objects) {
    models.push_back(static_cast<std::uint32_t>(scene.models.size()));
    scene.models.push_back(std::make_shared<const scene::PlantModel>(accel::pack(object.model)));
  }
  return scene::detail_kind(tile, models);
}

// A forest with two layers of details, of which the second begins where the first ends.
inline scene::Scene made_ground(const MadeForest& forest = {}) {
  scene::Scene scene = made_forest(forest);
  const auto tile = made_tile(300), other = made_tile(90, 0.7f);
  const scene::DetailKind kind = kind_in(scene, tile), other_kind = kind_in(scene, other);
  scene.details.push_back(scene::make_detail_layer(kind, made_details(scene, tile, {}), scene.origin, "first"));
  MadeGround beside;
  beside.west = 18;
  beside.east = 30;
  scene.details.push_back(
      scene::make_detail_layer(other_kind, made_details(scene, other, beside), scene.origin, "second"));
  scene::number_details(scene);
  return scene;
}

}  // namespace silvavis::testing
