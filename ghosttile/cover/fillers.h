// What plants make of the ground around them, worked out block by block on a lattice (lattice.h).
//
// Promise: pure functions of the place: plants add up in the one order of Plants. The land is taken to be level around each place.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "ghosttile/cover/lattice.h"
#include "ghosttile/cover/plants.h"

namespace ghosttile::cover {

// Which plants, for all below.
struct Chosen {
  std::shared_ptr<const Plants> plants;
  Selection selection;
};

// How much of the place crowns cover, in [0, 1]: 1 up to (1 - rim) of a crown's radius, falling smoothly to 0 at the crown's edge plus
// the reach, within which the wind carries what falls. Several crowns unite: 1 - product of (1 - cover).
struct CrownCover {
  float reach_m = 0;
  float rim = 0.25f;            // share of the radius, in [0, 1]
  std::vector<float> strength;  // by species: a single crown's most cover; empty: 1
};
float crown_cover_at(float distance_m, float radius_m, const CrownCover& cover);  // of one crown
std::unique_ptr<const Filler> crown_cover(Chosen chosen, CrownCover cover);

// Metres to the axis of the nearest stem, at most `most_m`.
std::unique_ptr<const Filler> stem_distance(Chosen chosen, float most_m);

// Stems a hectare, or their cross-sections in m2 a hectare, around the place: each stem counts by 2 (1 - (d/r)^2) / (pi r^2), which
// has the integral 1, so that the mean over a land is what there is (Epanechnikov 1969).
enum class DensityMeasure { stems, basal_area };
std::unique_ptr<const Filler> stand_density(Chosen chosen, float radius_m, DensityMeasure measure);

// Share of an overcast sky's light that comes down to the ground, in [0, 1]: 29 directions, through crowns as ellipsoids whose leaves
// let through exp(-depth) (Monsi and Saeki 1953). Crowns alone: no terrain, no stems, no light that leaves throw on.
struct Light {
  double month = 7;  // bare crowns shade less
  float leaf_area =
      5;  // m2 of leaves a m2 of ground below a crown, in summer; beech 5 to 8, oak 4 to 6, spruce 6 to 10
  float extinction = 0.5f;  // leaves at all angles
};
std::unique_ptr<const Filler> light(Chosen chosen, const Light& light);

// Smooth noise in [0, 1] around 0.5, in three octaves, the coarsest `size_m` wide: what makes patches where nothing else does.
std::unique_ptr<const Filler> patches(std::uint64_t seed, double size_m);

}  // namespace ghosttile::cover
