// Bark: tapered tubes around the axes of a skeleton.
#pragma once

#include "assets/grown/skeleton.h"
#include "assets/model.h"

namespace assets::grown {

// Which materials of the model the tubes wear.
struct BarkMaterials {
  std::uint16_t lower = 0, upper = 0, twig = 0;
  float upper_from_m = 0;  // height above which stems and branches wear `upper`
};

// Adds tubes of at most `most_triangles`: as many sides and joints as that allows, and without the thinnest twigs where
// it does not. Stems are lengthened below the ground. Returns the number of triangles added.
std::size_t add_wood(Model& model, const Skeleton& skeleton, const BarkMaterials& materials,
                     std::size_t most_triangles);

}  // namespace assets::grown
