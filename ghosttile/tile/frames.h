// Where candidates may be and how they may be turned: the frames of section 4.2.
//
// Source: Guérin et al. 2016, section 4.2 and figure 7. Uniform rotations after Marsaglia 1972 (Choosing a point from the surface of
// a sphere), which needs no sine.
#pragma once

#include <cstdint>
#include <vector>

#include "ghosttile/tile/ghost_tile.h"

namespace ghosttile::tile {

// A share of an object's candidates whose z-axis leans off the vertical by so much.
struct Tilt {
  float least_deg = 0, most_deg = 0;  // 0 to 180
  float share = 1;                    // relative to the other tilts'
};

// How an object is spread over the tile.
struct Spread {
  std::uint32_t count = 0;                // candidates
  float least_scale = 1, most_scale = 1;  // even in between
  std::vector<Tilt> tilts;                // none: turned anyhow; else about the vertical anyhow
};

// Candidate `index` of object `object`: a pure function of the numbers.
Candidate random_frame(std::uint64_t seed, std::uint16_t object, std::uint32_t index, const Spread& spread,
                       float side_m);

}  // namespace ghosttile::tile
