// Who grows: one plant, or none, on every site.
//
// Shape: one value per (tile position, site id), laid out by ecosystem::site_offsets().
// Promise: same bytes for the same seed, whatever the threads.
// Source: Silva 2013, sections 4.2.3 and 4.3; docs/reading.md, B4.
#pragma once

#include <cstdint>
#include <vector>

#include "silvasim/base/progress.h"
#include "silvasim/config/scenario.h"
#include "silvasim/ecosystem/ecosystem.h"
#include "silvasim/evaluators/suitability.h"

namespace silvasim::population {

struct Population {
  std::vector<ecosystem::PlantId> plants;      // no_plant: nothing stands there
  std::vector<ecosystem::PlantId> candidates;  // which species the site takes, whether chance lets it come up or not
  std::vector<float> probability;              // growth probability of the site's candidate, 0 where there is none
};

// From the abiotic place alone: each site takes its candidate, which stands or not by chance. `seed`: the layer's.
Population establish(const evaluators::Suitability& suitability, const evaluators::Ground& ground,
                     const config::LayerSettings& layer, std::uint64_t seed, const base::Progress& progress = {});

// The seed of a layer's draws; layers of one scenario draw apart.
std::uint64_t layer_seed(std::uint64_t seed, std::size_t layer);

}  // namespace silvasim::population
