// Darts are tested as the floats that will be written, in the frame of the tile that they lie in.
#include "silvasim/tiles/throw_discs.h"

#include <gtest/gtest.h>

#include <cmath>

namespace silvasim::tiles {
namespace {

TEST(ThrowDiscs, CoordinatesAreFloatsOfTheirTile) {
  for (const double side : {1000.0, 333.3333333, 64.1}) {
    config::TileSettings settings;
    settings.side_m = side;
    const Radii radii(settings);
    const double density = radii.sites_per_m2(0.5);
    const Region region(base::Box{-30, -30, side + 30, side + 30});
    DiscGrid grid = grid_for(region.bounds(), settings.most_radius_m, density);
    base::Stream random(1, base::Purpose::tile_discs);
    const std::vector<Disc> discs = throw_discs(grid, region, radii, {side, density}, random);
    ASSERT_GT(discs.size(), 50u);
    for (const Disc& disc : discs) {
      for (const double x : {disc.x, disc.y}) {
        const double in_tile = x < 0 ? x + side : (x >= side ? x - side : x);
        EXPECT_NEAR(static_cast<double>(static_cast<float>(in_tile)), in_tile, 1e-12);
      }
      EXPECT_EQ(static_cast<double>(static_cast<float>(disc.radius)), disc.radius);
    }
  }
}

TEST(ThrowDiscs, LargestFirstAndAsManyAsTheAreaAsks) {
  config::TileSettings settings;
  const Radii radii(settings);
  const double density = radii.sites_per_m2(0.4);
  double thrown = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Region region(base::Box{0, 0, 70, 90});
    DiscGrid grid = grid_for(region.bounds(), settings.most_radius_m, density);
    base::Stream random(seed, base::Purpose::tile_discs);
    const std::vector<Disc> discs = throw_discs(grid, region, radii, {200, density}, random);
    for (std::size_t i = 1; i < discs.size(); ++i) EXPECT_LE(discs[i].radius, discs[i - 1].radius);
    thrown += static_cast<double>(discs.size()) / 50;
  }
  EXPECT_NEAR(thrown, density * 70 * 90, 0.3) << "the fraction is rounded at random";
}

TEST(ThrowDiscs, LeavesOutWhatFindsNoRoom) {
  config::TileSettings settings;
  settings.least_radius_m = settings.most_radius_m = 8;
  const Radii radii(settings);
  const Region region(base::Box{0, 0, 100, 100});
  DiscGrid grid = grid_for(region.bounds(), 8, 0.01);
  base::Stream random(1, base::Purpose::tile_discs);
  const std::vector<Disc> discs = throw_discs(grid, region, radii, {200, 0.01, 200}, random);
  EXPECT_LT(discs.size(), 30u);
  EXPECT_GT(discs.size(), 15u);
}

}  // namespace
}  // namespace silvasim::tiles
