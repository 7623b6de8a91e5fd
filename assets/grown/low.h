// Plants without wood: ferns and grasses.
#pragma once

#include "assets/grown/form.h"
#include "assets/model.h"

namespace assets::grown {

// Fronds that arch from one foot, with pinnae left and right.
void add_fern(Model& model, const Form& form, float height_m, float radius_m, std::uint64_t seed,
              std::size_t triangles);

// Curved blades from one foot, and a few flowering stalks above them.
void add_grass(Model& model, const Form& form, float height_m, float radius_m, std::uint64_t seed,
               std::size_t triangles);

}  // namespace assets::grown
