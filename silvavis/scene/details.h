// From what was filled to what is traced.
//
// Promise: the same instances, in no other place: nothing is left out. Where details are filled around a moving camera, layers can be made anew
//   from the same models; nothing else refers to a layer.
// Errors: base::Error for more than 2^32 instances.
// Threads: parallel inside. Cost: 40 ns an instance.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "ghosttile/fill/details.h"
#include "ghosttile/tile/ghost_tile.h"
#include "silvasim/base/geometry.h"
#include "silvavis/scene/scene.h"

namespace silvavis::scene {

// What is the same for all layers of a Ghost Tile: its candidates with their boxes and colours.
struct DetailKind {
  DetailLayer empty;              // frames, boxes, objects; nothing stands there
  std::vector<float> covered_m2;  // by candidate, seen from above
  std::vector<Rgb> colours;       // by object: mean reflectance
};

// `models`: by object, into Scene::models.
DetailKind detail_kind(const ghosttile::tile::GhostTile& tile, std::span<const std::uint32_t> models);

DetailLayer make_detail_layer(const DetailKind& kind, const ghosttile::fill::Details& details,
                              silvasim::base::Point origin, std::string name);

// Numbers for pictures: after those of the plants' layers and of the layers before.
void number_details(Scene& scene);

}  // namespace silvavis::scene
