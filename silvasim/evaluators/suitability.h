// How well each species would do on each site of the tiling, from the abiotic place alone.
//
// Shape: probability[site * species + s], sites position by position in the tiling's order, each tile's in its own order.
// No data: `excluded` (-1) where a species cannot grow; sites outside the scene's extent exclude all.
// Promise: same bytes whatever the threads. The largest value after a NormalizeEvaluator is exactly 1, or all are 0.
// Source: Silva 2013, section 4.2.3; docs/reading.md, B1.
#pragma once

#include <cstdint>
#include <vector>

#include "silvasim/base/lazy_vector.h"
#include "silvasim/base/progress.h"
#include "silvasim/evaluators/ground.h"
#include "silvasim/evaluators/network.h"

namespace silvasim::evaluators {

struct Suitability {
  std::size_t species = 0;
  base::LazyVector<float> probability;
  std::vector<float> maxima;  // what each NormalizeEvaluator divided by (0: nothing to divide)
  // Of the sites inside the scene: how many, and on how many each of Network::fields() has no data.
  std::uint64_t inside = 0;
  std::vector<std::uint64_t> no_data;
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
  // Sites inside the scene, of those that are flagged; null: of all.
  std::uint64_t count_inside(const std::uint8_t* flagged) const;
};

}  // namespace silvasim::evaluators
