// Whether two answers are the same to the last bit.
#pragma once

#include <cstring>

#include "silvavis/accel/tracer.h"

namespace silvavis::testing {

template <typename Value>
bool same_bits(const Value& a, const Value& b) {
  return std::memcmp(&a, &b, sizeof(Value)) == 0;
}

inline bool same(const accel::Hit& a, const accel::Hit& b) {
  return same_bits(a.distance, b.distance) && a.surface == b.surface && a.layer == b.layer && a.species == b.species &&
         a.column == b.column && a.row == b.row && a.site_slot == b.site_slot && a.model == b.model &&
         a.level == b.level && a.slot == b.slot && same_bits(a.u, b.u) && same_bits(a.v, b.v);
}

}  // namespace silvavis::testing
