// Grows a plant: the models that Silva makes itself, so that a clone renders without downloads.
//
// Units: metres, z up, the stem's foot at the origin. Stems go on below the ground by two of their radii and 0.3 m, so that
//   nothing floats on slopes.
// Shape: the highest vertex lies at height_m, the farthest from the axis at radius_m. Bark is tapered tubes, foliage are
//   cards with an alpha-cut texture of a spray: few leaves of true size on many small cards where there are many
//   triangles, many leaves on large cards where there are few, with the same leaf area in all. Where there are more
//   triangles than sprays, the cards are folded and bent.
// Materials: bark, then leaves in three shades that share a texture. Leaf normals lean outward from the crown a little.
// Promise: model.h's; the same bytes for the same arguments on every machine. The wood and its twigs are the same for
//   every detail of a seed. Triangles: within 15 % of the target.
// Errors: base::Error where height or radius is not a positive number below 1000 m, or the detail is below 1000 triangles
//   or above 20 million.
// Threads: any number at once. Cost: about 0.15 s for 160,000 triangles, 0.1 s for 5,000.
// Source: recursive branching after Weber and Penn 1995 (Creation and rendering of realistic trees), with lengths from the
//   crown's outline instead of tables; leaves as alpha-cut sprays are common practice.
#pragma once

#include <cstdint>

#include "assets/grown/form.h"
#include "assets/model.h"

namespace assets::grown {

// How many triangles a plant may have.
struct Detail {
  int triangles = 160000;

  static const Detail least, medium, high;  // 5, 40 and 160 thousand
};
inline constexpr Detail Detail::least{5000};
inline constexpr Detail Detail::medium{40000};
inline constexpr Detail Detail::high{160000};

Model grow(const Form& form, double height_m, double radius_m, std::uint64_t seed, Detail detail);

}  // namespace assets::grown
