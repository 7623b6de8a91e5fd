// The project's own details: leaves, twigs, stones, tufts and more, grown from a seed, so that a clone fills scenes without downloads.
//
// Units: metres. Shape: z is the axis that candidates are tilted by: a leaf's normal, a stone's shortest axis, up for what
//   stands. The origin is in the middle of what lies (leaves, twigs, stones, needles, straws, cones), at the foot of what
//   stands (tufts, mushrooms). What lies is `length_m` long in x; what stands is `length_m` high.
// Promise: assets/model.h's; at most `most_triangles`; the same bytes for the same options on every machine; another seed is
//   another one of its kind. All but leaves and tufts enclose a volume.
// Errors: base::Error for an unknown form (with the nearest name), a length that is not above 0 or above 100 m.
// Threads: any number at once. Cost: below 0.1 s, most of it painting the texture.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "assets/model.h"

namespace ghosttile::objects::made {

enum class Season : std::uint8_t {
  summer,  // green; needles fresh
  autumn,  // fallen: leaves coloured and curled, grass going yellow
  winter,  // leaves brown, grass and needles dead
};

struct MadeOptions {
  std::string form;    // a name of made_forms()
  float length_m = 0;  // 0: the form's own
  std::uint64_t seed = 0;
  Season season = Season::autumn;  // matters for leaves, tufts and needles
  std::optional<assets::Rgb>
      colour;  // mean linear reflectance instead of the form's own; a mushroom's is that of its cap
};

struct MadeForm {
  std::string name;
  std::string help;  // one line
  float length_m = 0;
  std::size_t most_triangles = 0;
  // Spheres that suit it: so many, fitted with this outside_share (sphere_fit.h); or, where foot_share is above 0, a single
  // one around the foot with that share of the height as radius, because blades of neighbours go through each other.
  int spheres = 24;
  float outside_share = 0.1f;
  float foot_share = 0;
};

const std::vector<MadeForm>& made_forms();

assets::Model make(const MadeOptions& options);

// "summer", "autumn", "winter"
std::optional<Season> season_named(const std::string& name);

}  // namespace ghosttile::objects::made
