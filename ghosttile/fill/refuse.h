// Refusal: of the chosen, so many are left out that the density is kept where it is below 1.
//
// After selection, never before: a refused candidate still bars its neighbours, so that the number of instances goes with the
//   density (docs/ghost-tiles.md, E4).
// Source: Guérin et al. 2016, section 5.3: a candidate is instantiated if u <= ||f||, the L1 norm over all objects' densities.
#pragma once

#include <cstdint>
#include <vector>

#include "ghosttile/fill/survivors.h"

namespace ghosttile::fill {

// By block of survivors.blocks: takes the refused out of `chosen` (by slot, as Survivors::alive), into `refused`.
void refuse(const Plan& plan, const Survivors& survivors, std::vector<std::uint64_t>& chosen,
            std::vector<std::uint64_t>& refused);

}  // namespace ghosttile::fill
