// The leaves of a model: connected pieces whose material is cut out by a texture or lets light through.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "assets/model.h"
#include "silvavis/base/vector.h"

namespace silvavis::levels {

bool is_leaf(const assets::Material& material);

struct Leaf {
  std::uint32_t first = 0, count = 0;  // in Leaves::triangles
  V3 centre{0, 0, 0};
  float area = 0;
  std::uint64_t place = 0;  // along a curve through the crown, once they are put in its order
};

struct Leaves {
  std::vector<std::uint32_t> triangles;  // leaf by leaf, each leaf's in the model's order
  std::vector<Leaf> leaves;

  std::span<const std::uint32_t> of(const Leaf& leaf) const {
    return std::span(triangles).subspan(leaf.first, leaf.count);
  }
};

// In the order of their first triangles. Threads: any.
Leaves leaves_of(const assets::Model& model);

// Puts them in the order of a curve through the crown, so that even steps through the order are even in space.
void put_along_curve(const assets::Model& model, Leaves& leaves);

}  // namespace silvavis::levels
