// Plants gathered in hexagons, for maps that would hold too many circles.
//
// Each hexagon shows one species, chosen so that over an area the hexagons of a species are as many as its share of the
// crowns: an evenly spread number a hexagon picks from the species' cumulative crown areas.
// Threads: works in parallel inside; a hexagon is summed in file order by one thread.
#pragma once

#include <vector>

#include "silvasim/export/view.h"

namespace silvasim::exports {

struct Hexagon {
  float x = 0, y = 0;     // centre, pixels of the view
  float covered = 0;      // share of its area under crowns of the shown species
  float probability = 0;  // mean of its species' plants
};

struct HexagonLayer {
  std::vector<std::vector<Hexagon>> species;
};

// `across_px`: from side to opposite side; the points look north and south.
HexagonLayer gather(const ecosystem::Layer& layer, const std::vector<SpeciesCount>& counts,
                    const std::vector<std::uint64_t>& offsets, const View& view, double across_px);

}  // namespace silvasim::exports
