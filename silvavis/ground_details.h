// Ground detail in a scene: the models of a Ghost Tile's objects, and layers of what was filled.
//
// Shape: models are made once a Ghost Tile (add_detail_kind); a layer is made of them and of any Details (detail_layer), so that
//   what is filled around a moving camera may replace the layer of a picture before: scene.details[k] = detail_layer(...).
// Errors: base::Error for a model that cannot be packed. Threads: parallel inside.
// Cost: 10 ms an object; a layer 40 ns an instance and 20 ms for how it looks from afar.
#pragma once

#include <string>

#include "silvavis/scene/details.h"

namespace silvavis {

struct DetailOptions {
  bool fades = true;   // what is smaller than half a pixel is left out, and the ground takes its colour
  bool levels = true;  // simpler models of what has many leaves
  // A layer of the same kind to look like from afar, instead of measuring it: for layers that are made again and again.
  const scene::DetailLayer* like = nullptr;
};

// Adds the models to the scene.
scene::DetailKind add_detail_kind(scene::Scene& scene, const ghosttile::tile::GhostTile& tile,
                                  const DetailOptions& options = {});

// Not yet part of the scene; refers to its models.
scene::DetailLayer detail_layer(const scene::Scene& scene, const scene::DetailKind& kind,
                                const ghosttile::fill::Details& details, const std::string& name,
                                const DetailOptions& options = {});

}  // namespace silvavis
