// Plants without wood: ferns and grasses.
#pragma once

#include "silvavis/assets/grown/form.h"
#include "silvavis/assets/model.h"

namespace silvavis::assets::grown {

// Fronds that arch from one foot, with pinnae left and right.
void add_fern(Model& model, const Form& form, float height_m, float radius_m, std::uint64_t seed,
              std::size_t triangles);

// Curved blades from one foot, and a few flowering stalks above them.
void add_grass(Model& model, const Form& form, float height_m, float radius_m, std::uint64_t seed,
               std::size_t triangles);

}  // namespace silvavis::assets::grown
