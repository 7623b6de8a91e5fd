// The background grid against brute force on the closed window.
#include "silvasim/tiles/disc_grid.h"

#include <gtest/gtest.h>

#include <cmath>

#include "silvasim/base/random.h"
#include "silvasim/tiles/region.h"

namespace silvasim::tiles {
namespace {

TEST(DiscGrid, AnswersAsBruteForceDoes) {
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    base::Stream random(seed, base::Purpose::tile_discs);
    const double most = 0.5 + 4 * random.next_double(), gap = seed % 2 == 0 ? 0.0 : 0.01 * most;
    const base::Box window{-3, 7, -3 + most * (6 + 20 * random.next_double()),
                           7 + most * (6 + 20 * random.next_double())};
    DiscGrid grid(window, most, gap, most * (0.05 + 2 * random.next_double()));
    std::vector<Disc> discs;
    int yes = 0, no = 0;
    for (int i = 0; i < 3000; ++i) {
      const Disc disc{window.west + random.next_double() * window.width(),
                      window.south + random.next_double() * window.height(), most * (0.1 + 0.9 * random.next_double())};
      bool fits = true;
      for (const Disc& other : discs) {
        // The window closes on itself: the nearest of the copies counts.
        const double dx = std::remainder(other.x - disc.x, window.width());
        const double dy = std::remainder(other.y - disc.y, window.height());
        if (dx * dx + dy * dy < std::pow(other.radius + disc.radius + gap, 2)) fits = false;
      }
      ASSERT_EQ(grid.fits(disc), fits) << "seed " << seed << ", dart " << i;
      ++(fits ? yes : no);
      if (!fits) continue;
      grid.add(disc);
      discs.push_back(disc);
    }
    EXPECT_GT(yes, 5);
    EXPECT_GT(no, 5);
  }
}

TEST(Region, DrawsUniformlyAndOnlyInside) {
  const std::vector<double> cuts{0, 1, 3, 7};
  const Region region(cuts, cuts, [](base::Point p) { return !(p.x > 1 && p.x < 3 && p.y > 1 && p.y < 3); });
  EXPECT_DOUBLE_EQ(region.area_m2(), 49 - 4);
  base::Stream random(1, base::Purpose::tile_discs);
  int west = 0;
  constexpr int draws = 100'000;
  for (int i = 0; i < draws; ++i) {
    const base::Point p = region.draw(random);
    ASSERT_TRUE(region.contains(p));
    ASSERT_FALSE(p.x >= 1 && p.x < 3 && p.y >= 1 && p.y < 3);
    west += p.x < 1 ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(west) / draws, 7.0 / 45, 0.005);
  EXPECT_FALSE(region.contains({7, 3}));
  EXPECT_TRUE(region.contains({0, 0}));
}

}  // namespace
}  // namespace silvasim::tiles
