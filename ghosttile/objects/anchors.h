// Anchor points: where a detail asks the density field whether it may be. One that lies outside of the field discards it.
//
// Units: metres, the object's space. Promise: one at least; sampled ones are spread by farthest points, so the first n of
//   more are n well spread ones too. Same bytes for the same arguments anywhere.
// Errors: base::Error naming the model: no anchor given, one that is not finite, a count out of range; surface.h's.
// Source: Guérin et al. 2016, sections 4.1 and 5.1, figures 5 and 12.
#pragma once

#include <cstdint>
#include <vector>

#include "ghosttile/objects/detail.h"

namespace ghosttile::objects {

enum class AnchorPlaces : std::uint8_t {
  origin,   // one, at (0, 0, 0)
  given,    // `given`
  centre,   // one, at centre_of()
  foot,     // one, at foot_of()
  volume,   // `count` within it; on the surface where it encloses no volume
  surface,  // `count` on it
};

inline constexpr int most_anchors = 256;

struct AnchorOptions {
  AnchorPlaces places = AnchorPlaces::origin;
  int count = 1;
  std::vector<assets::V3> given{};
  std::uint64_t seed = 0;
};

std::vector<assets::V3> anchors_of(const assets::Model& model, const AnchorOptions& options);

// The middle of the volume, of the surface where there is none.
assets::V3 centre_of(const assets::Model& model);

// The lowest corner; the middle of those that are as low.
assets::V3 foot_of(const assets::Model& model);

}  // namespace ghosttile::objects
