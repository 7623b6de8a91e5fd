// A model's wood in fewer triangles, by meshoptimizer.
#pragma once

#include <cstddef>

#include "assets/model.h"
#include "silvavis/base/vector.h"

namespace silvavis::levels {

// Adds what is no leaf of `from` to `to`, which has the same materials, with about `target` triangles.
void add_wood(const assets::Model& from, std::size_t target, assets::Model& to);

}  // namespace silvavis::levels
