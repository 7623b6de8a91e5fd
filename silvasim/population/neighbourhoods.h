// Lets neighbours compete: the field-of-neighbourhood passes.
//
// The paper's Algorithm 2 in blocks of about 32 x 32 grid cells. Within a block: draw a cell among those that still hold
// unfixed sites, fix its most certain site to its most likely plant, and let that plant act on the unfixed sites around
// it. Blocks run in four colours, so that no two of one colour are neighbours; a block starts from the abiotic
// probabilities, weighed with the plants that stand around it by then. Further passes start again from the abiotic
// probabilities, with the last pass's plants as neighbours.
//
// A plant acts on a neighbour at distance d by the factor 1 + I * F(d), not below 0, where I is the influence of its
// species on the neighbour's and F its field (Berger and Hildenbrandt 2000). A plant that chance does not let come up acts
// on none.
//
// Promise: every site is fixed once a pass; same bytes whatever the threads; without influences the same plants as
//   establish().
// Memory: nothing but the population for all sites; probabilities are copied a block at a time.
// Source: Silva 2013, section 4.3; docs/reading.md, C1 to C5.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "silvasim/population/population.h"

namespace silvasim::population {

struct NeighbourhoodReport {
  int passes = 0;
  std::vector<std::uint64_t>
      changed;                // a pass: sites whose plant differs from the pass before (the first: plants standing)
  std::uint64_t fixings = 0;  // in all passes
  double cell_m = 0;          // the grid cell that was used: it divides the tile's side, or is a multiple of it
  int block_tiles = 0;        // tiles along a block's side
};

struct NeighbourhoodOptions {
  bool one_block = false;  // the whole land as one block: the paper's sequential algorithm, for comparison
  std::optional<std::uint64_t> watch = std::nullopt;  // a site, for explanations: which plants acted on it?
};

// A plant that acted on the watched site.
struct ActingPlant {
  std::uint64_t site = 0;  // its own
  ecosystem::PlantId species = ecosystem::no_plant;
  float distance_m = 0;
  float strength = 0;  // of its field at the watched site, in (0,1]
};

struct Competition {
  Population population;
  NeighbourhoodReport report;
  std::vector<ActingPlant> acting;  // on the watched site when it was fixed in the last pass
};

Competition compete(const evaluators::Suitability& suitability, const evaluators::Ground& ground,
                    const config::LayerSettings& layer, std::uint64_t seed, const NeighbourhoodOptions& options = {},
                    const base::Progress& progress = {});

}  // namespace silvasim::population
