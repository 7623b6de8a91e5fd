// How well each species would do on each site of the tiling, from the abiotic place alone.
//
// Shape: probability[site * species + s], sites position by position in the tiling's order, each tile's in its own order.
// No data: `excluded` (-1) where a species cannot grow; sites outside the scene's extent exclude all.
// Promise: same bytes whatever the threads. The largest value after a NormalizeEvaluator is exactly 1, or all are 0.
// Source: Silva 2013, section 4.2.3; docs/reading.md, B1.
#pragma once

#include <cstdint>
#include <vector>

#include "silvasim/base/progress.h"
#include "silvasim/evaluators/network.h"
#include "silvasim/fields/field_set.h"
#include "silvasim/tiles/tile_set.h"

namespace silvasim::evaluators {

// The land as the layer sees it: which sites there are, and where.
struct Ground {
  const tiles::TileSet& tile_set;
  const tiles::Tiling& tiling;
  base::Point north_west;                     // scene point of the tiling's corner
  const std::vector<std::uint64_t>& offsets;  // first site of each tile position, and the total
  const fields::FieldSet& fields;
};

struct Suitability {
  std::size_t species = 0;
  std::vector<float> probability;
  std::vector<float> maxima;  // what each NormalizeEvaluator divided by (0: nothing to divide)
};

Suitability evaluate_sites(const Network& network, const Ground& ground, const base::Progress& progress = {});

// The columns of a run of sites that belong to one block; for evaluate_sites and for explanations.
struct SiteColumns {
  std::vector<double> x, y;
  std::vector<float> radius_m;
  std::vector<std::vector<float>> value;
  std::vector<std::vector<std::uint8_t>> no_data;
  std::vector<std::uint8_t> outside;  // 1 where the site lies outside the scene

  // Samples the network's fields at the points.
  void sample(const Network& network, const fields::FieldSet& fields);
  Network::Block block() const;
};

}  // namespace silvasim::evaluators
