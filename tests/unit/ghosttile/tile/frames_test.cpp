#include "ghosttile/tile/frames.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "ghosttile/tile/hilbert.h"

namespace ghosttile::tile {
namespace {

constexpr double degrees = 180 / 3.14159265358979;

TEST(Frames, AreRotations) {
  Spread spread;
  spread.tilts = {};
  for (std::uint32_t c = 0; c < 200; ++c) {
    const Candidate candidate = random_frame(1, 0, c, spread, 0.5f);
    const V3 x = candidate.rotation({1, 0, 0}), y = candidate.rotation({0, 1, 0}), z = candidate.rotation({0, 0, 1});
    EXPECT_NEAR(x.length(), 1, 1e-5);
    EXPECT_NEAR(x.dot(y), 0, 1e-5);
    EXPECT_NEAR((x.cross(y) - z).length(), 0, 1e-5);
    EXPECT_NEAR((candidate.rotation.z_axis() - z).length(), 0, 1e-5);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(candidate.at[axis], 0);
      EXPECT_LT(candidate.at[axis], 0.5f);
    }
  }
}

TEST(Frames, RandomTurnsFavourNoDirection) {
  const Spread spread;
  constexpr int count = 20000;
  V3 sum_z(0, 0, 0), sum_x(0, 0, 0);
  double squares = 0;
  for (std::uint32_t c = 0; c < count; ++c) {
    const Rotation rotation = random_frame(2, 0, c, spread, 1).rotation;
    sum_z += rotation.z_axis();
    sum_x += rotation({1, 0, 0});
    squares += double{rotation.z_axis().z} * double{rotation.z_axis().z};
  }
  EXPECT_LT((sum_z / count).length(), 0.02f);
  EXPECT_LT((sum_x / count).length(), 0.02f);
  EXPECT_NEAR(squares / count, 1.0 / 3, 0.01);
}

// Figure 7 of the paper: three in four between 0 and 30 degrees, one in four between 45 and 60.
TEST(Frames, TiltsAreSharedOutAsAsked) {
  Spread spread;
  spread.tilts = {{0, 30, 0.75f}, {45, 60, 0.25f}};
  constexpr int count = 20000;
  int flat = 0, inclined = 0;
  V3 sum(0, 0, 0), turns(0, 0, 0);
  for (std::uint32_t c = 0; c < count; ++c) {
    const Rotation rotation = random_frame(3, 1, c, spread, 1).rotation;
    const double tilt = std::acos(std::min(1.0, double{rotation.z_axis().z})) * degrees;
    flat += tilt <= 30.01 ? 1 : 0;
    inclined += tilt >= 44.99 && tilt <= 60.01 ? 1 : 0;
    sum += rotation.z_axis();
    turns += rotation({1, 0, 0});
  }
  EXPECT_EQ(flat + inclined, count);
  EXPECT_NEAR(flat / double{count}, 0.75, 0.012);
  EXPECT_LT(std::hypot(sum.x, sum.y) / count, 0.02);
  EXPECT_LT(turns.length() / count, 0.02);
}

TEST(Hilbert, NeighboursAlongTheCurveAreNeighboursInSpace) {
  constexpr int side = 16;
  std::map<std::uint32_t, V3> along;
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const V3 at(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
        along[hilbert_place((at + V3(0.01f, 0.01f, 0.01f)) / side)] = at;
      }
  ASSERT_EQ(along.size(), static_cast<std::size_t>(side * side * side));
  const V3* before = nullptr;
  for (const auto& [place, at] : along) {
    if (before) {
      ASSERT_NEAR((at - *before).length(), 1, 1e-6) << place;
    }
    before = &at;
  }
}

}  // namespace
}  // namespace ghosttile::tile
