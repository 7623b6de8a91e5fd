// The choice of one site: which species is its candidate, and whether it comes up.
#pragma once

#include <cstddef>
#include <cstdint>

#include "silvasim/config/scenario.h"
#include "silvasim/ecosystem/ecosystem.h"

namespace silvasim::population {

// A site's name, by which its draws are keyed.
struct SiteKey {
  std::uint32_t column = 0, row = 0, site = 0;
};

struct Choice {
  ecosystem::PlantId candidate = ecosystem::no_plant;
  float probability = 0;  // of the candidate
  bool stands = false;
};

// `probability`: one value a species, negative where it is excluded. A candidate has a probability above 0.
// most-likely: the highest, of equals the first. weighted: a draw in proportion.
Choice choose(const float* probability, std::size_t species, config::Selection selection, config::Chance chance,
              std::uint64_t seed, SiteKey key);

}  // namespace silvasim::population
