// Small forests for tests: hills, tiles, plants whose every figure the test knows.
#pragma once

#include <cstdint>
#include <memory>

#include "assets/model.h"
#include "silvavis/scene/scene.h"

namespace silvavis::testing {

struct MadeForest {
  int columns = 5, rows = 4;  // tile positions
  double side_m = 60;
  double coverage = 0.45;
  double hills_m = 40;  // 0: flat
  double cell_m = 17;   // of the terrain
  double west = 500000, south = 5600000;
  bool shrubs = true;  // a second layer with smaller tiles
  std::uint64_t seed = 1;
};

// A ball of leaves on a stem; with holes, a third of each leaf is cut out by a texture.
assets::Model leaf_ball(int leaves, double height_m, double radius_m, bool holes, std::uint64_t seed);

silvasim::ecosystem::Ecosystem made_ecosystem(const MadeForest& made);
// The same with models: two variants of a ball with holes, a slim one without.
scene::Scene made_forest(const MadeForest& made);

}  // namespace silvavis::testing
