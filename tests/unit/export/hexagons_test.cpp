#include "silvasim/export/hexagons.h"

#include <gtest/gtest.h>

#include <cmath>

#include "made_land.h"

namespace silvasim::exports {
namespace {

using testing::MadeLand;
using testing::make_land;

TEST(Hexagons, cover_what_the_crowns_cover) {
  MadeLand made;
  made.columns = 30;
  made.rows = 24;
  const ecosystem::Ecosystem land = make_land(made);
  const Census census = take_census(land, {}, land.extent);
  const View view{land.extent, 1000, 800};
  constexpr double across = 9;
  const HexagonLayer hexagons = gather(land.layers[0], census.layers[0], census.offsets[0], view, across);
  double covered_px = 0;
  for (const auto& species : hexagons.species) {
    for (const Hexagon& hexagon : species) covered_px += static_cast<double>(hexagon.covered);
  }
  covered_px *= across * across * std::sqrt(0.75);
  double crowns_m2 = 0;
  for (const SpeciesCount& count : census.layers[0]) crowns_m2 += count.crown_area_m2;
  EXPECT_NEAR(covered_px / (view.px_per_m() * view.px_per_m()), crowns_m2, crowns_m2 * 1e-4);
}

TEST(Hexagons, show_species_in_proportion_to_their_crowns) {
  // Two species without zones, one with a fifth of the plants.
  MadeLand made;
  made.columns = 40;
  made.rows = 30;
  made.species = 2;
  ecosystem::Ecosystem land = make_land(made);
  std::size_t i = 0;
  for (ecosystem::PlantId& plant : land.layers[0].plants) plant = (i++ % 5 == 0) ? 1 : 0;
  const Census census = take_census(land, {}, land.extent);
  const View view{land.extent, 800, 600};
  const HexagonLayer hexagons = gather(land.layers[0], census.layers[0], census.offsets[0], view, 8);
  const double few = static_cast<double>(hexagons.species[1].size());
  const double all = few + static_cast<double>(hexagons.species[0].size());
  const double share =
      census.layers[0][1].crown_area_m2 / (census.layers[0][0].crown_area_m2 + census.layers[0][1].crown_area_m2);
  EXPECT_GT(all, 5000);
  EXPECT_NEAR(few / all, share, 0.02);
}

}  // namespace
}  // namespace silvasim::exports
