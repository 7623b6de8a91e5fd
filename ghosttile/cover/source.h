// A quantity of the place that a rule answers to: the cover of crowns, light, slope, a data field.
//
// Units: each says its own. No data: NaN. Promise: a pure function of the place. Threads: any.
#pragma once

#include <cstddef>

#include "ghosttile/density/field.h"
#include "silvasim/base/geometry.h"

namespace ghosttile::cover {

using assets::V3d;
using density::Range;

struct SourceRange {
  Range known;           // all values that there may be; least > most: no data anywhere
  bool missing = false;  // there may be places without data
};

class Source {
 public:
  virtual ~Source() = default;
  // As density::Plane::sample, but NaN where there is no data.
  virtual void sample(const V3d& origin, const float* x, const float* y, std::size_t count, float* value) const = 0;
  virtual SourceRange range(const silvasim::base::Box& box) const = 0;
  // What a rule answers where there is no data, in [0, 1].
  virtual float without_data() const { return 0; }
};

}  // namespace ghosttile::cover
