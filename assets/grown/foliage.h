// Leaves: cards with sprays along the twigs of a skeleton.
#pragma once

#include "assets/grown/skeleton.h"
#include "assets/model.h"

namespace assets::grown {

struct FoliageBudget {
  std::size_t triangles = 0;
  float leaf_area_m2 = 0;  // one-sided, of all leaves
};

// Adds as many cards as there are triangles for, three leaf materials and their texture.
void add_foliage(Model& model, const Skeleton& skeleton, const Form& form, float height_m, std::uint64_t seed,
                 const FoliageBudget& budget);

}  // namespace assets::grown
