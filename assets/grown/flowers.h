// Flower heads or fruit at the ends of the outer twigs.
#pragma once

#include "assets/grown/skeleton.h"
#include "assets/model.h"

namespace assets::grown {

// Adds two triangles a head, their material and texture; nothing where the form has none. Returns the triangles added.
std::size_t add_flowers(Model& model, const Skeleton& skeleton, const Form& form, float height_m, std::uint64_t seed);

}  // namespace assets::grown
