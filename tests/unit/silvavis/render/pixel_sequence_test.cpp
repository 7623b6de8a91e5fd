// Samples of pixels: stratified in each pixel, even over neighbours, and a function of their names.
#include "silvavis/pixel_sequence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace silvavis {
namespace {

TEST(PixelSequence, StratifiesThePixelAndItsNeighbours) {
  for (std::size_t pair = 0; pair < PixelSequence::pairs; ++pair) {
    for (int y = 0; y < 20; ++y) {
      for (int x = 0; x < 20; ++x) {
        const PixelSequence sequence(7, x, y, 16);
        // Sixteen samples: one in each sixteenth of both axes and in each cell of 4 x 4; each four: in each quarter.
        std::set<int> columns, rows, cells;
        for (int k = 0; k < 16; ++k) {
          const auto [u, v] = sequence.at(pair, k);
          ASSERT_TRUE(u >= 0 && u < 1 && v >= 0 && v < 1);
          columns.insert(static_cast<int>(u * 16));
          rows.insert(static_cast<int>(v * 16));
          cells.insert(static_cast<int>(u * 4) * 4 + static_cast<int>(v * 4));
        }
        EXPECT_EQ(columns.size(), 16u);
        EXPECT_EQ(rows.size(), 16u);
        EXPECT_EQ(cells.size(), 16u);
        for (int first = 0; first < 16; first += 4) {
          std::set<int> quarters;
          for (int k = first; k < first + 4; ++k) quarters.insert(static_cast<int>(sequence.at(pair, k)[0] * 4));
          EXPECT_EQ(quarters.size(), 4u);
        }
      }
    }
    // One sample each: 4 x 4 pixels, aligned, share the square.
    std::set<int> cells;
    for (int y = 8; y < 12; ++y)
      for (int x = 4; x < 8; ++x) {
        const auto [u, v] = PixelSequence(7, x, y, 1).at(pair, 0);
        cells.insert(static_cast<int>(u * 4) * 4 + static_cast<int>(v * 4));
      }
    EXPECT_EQ(cells.size(), 16u);
  }
}

TEST(PixelSequence, IsTheSameWhereverItCameFrom) {
  for (const int samples : {1, 4, 16, 100}) {
    PixelSequence moving(5, 3, 3, samples);
    for (const auto& [x, y] : std::vector<std::pair<int, int>>{{3, 3},
                                                               {4, 3},
                                                               {3, 4},
                                                               {1919, 1079},
                                                               {0, 0},
                                                               {15, 16},
                                                               {16, 15},
                                                               {30000, 7},
                                                               {65535, 65535},
                                                               {70000, 1}}) {
      moving.move_to(x, y);
      const PixelSequence anew(5, x, y, samples);
      for (std::size_t pair = 0; pair < PixelSequence::pairs; ++pair)
        for (int k = 0; k < samples; ++k) EXPECT_EQ(moving.at(pair, k), anew.at(pair, k)) << x << ", " << y;
    }
  }
}

TEST(PixelSequence, IntegratesBetterThanChanceAndItsErrorIsOfHighFrequency) {
  // Light of a sky behind an edge: f = 1 where u + v < 0.8, whose integral is 0.32.
  constexpr int side = 64;
  const auto variances = [](int samples) {
    std::vector<double> error;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const PixelSequence sequence(3, x, y, samples);
        double sum = 0;
        for (int k = 0; k < samples; ++k) {
          const auto [u, v] = sequence.at(1, k);
          sum += u + v < 0.8f ? 1 : 0;
        }
        error.push_back(sum / samples - 0.32);
      }
    }
    double squared = 0, blurred = 0;
    for (const double e : error) squared += e * e;
    for (int y = 0; y < side; y += 4) {
      for (int x = 0; x < side; x += 4) {
        double sum = 0;
        for (int j = 0; j < 4; ++j)
          for (int i = 0; i < 4; ++i) sum += error[static_cast<std::size_t>((y + j) * side + x + i)];
        blurred += sum / 16 * (sum / 16);
      }
    }
    return std::array{squared / (side * side), blurred / (side * side / 16.0)};
  };
  for (const int samples : {4, 8, 16}) {
    const auto [one, blurred] = variances(samples);
    EXPECT_LT(one, 0.5 * 0.32 * 0.68 / samples) << samples;  // half the variance of independent draws at most
    // Blurring takes away more than of independent pixels; most where the samples are a power of four.
    EXPECT_LT(blurred, (samples == 8 ? 0.9 : 0.5) * one / 16) << samples;
  }
}

TEST(PixelSequence, PairsAndSeedsAreIndependent) {
  double product = 0, other_seed = 0, mean = 0;
  int count = 0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      const PixelSequence a(1, x, y, 16), b(2, x, y, 16);
      for (int k = 0; k < 16; ++k, ++count) {
        const double u = static_cast<double>(a.at(0, k)[0]) - 0.5;
        product += u * (static_cast<double>(a.at(1, k)[0]) - 0.5);
        other_seed += u * (static_cast<double>(b.at(0, k)[0]) - 0.5);
        mean += u;
      }
    }
  }
  EXPECT_NEAR(mean / count, 0, 1e-3);
  EXPECT_NEAR(product / count * 12, 0, 0.04);
  EXPECT_NEAR(other_seed / count * 12, 0, 0.04);
  EXPECT_EQ(PixelSequence(5, 3000, 2000, 64).at(1, 63), PixelSequence(5, 3000, 2000, 64).at(1, 63));
}

}  // namespace
}  // namespace silvavis
