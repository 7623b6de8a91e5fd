#include "ghosttile/density/size.h"

#include <array>

namespace ghosttile::density {

void scale_limits(const SizeField& size, const Compiled& field, const Points& points, Scratch& scratch, float* least,
                  float* most) {
  std::array<float, block_size> share;
  field.evaluate(points, scratch, share.data());
  for (std::size_t i = 0; i < points.count; ++i) {
    const float full = share[i] < 1 ? share[i] : 1, none = 1 - full;
    least[i] = none * size.where_none.least + full * size.where_full.least;
    most[i] = none * size.where_none.most + full * size.where_full.most;
  }
}

}  // namespace ghosttile::density
