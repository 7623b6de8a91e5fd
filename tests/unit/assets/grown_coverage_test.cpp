// Details of the same plant must be interchangeable from afar: they cover as much, in the same places, in the same
// colour. Measured by a rasteriser that shares nothing with the generator or the renderer.
#include <gtest/gtest.h>

#include <cmath>

#include "grown_support.h"

namespace assets::grown_tests {
namespace {

using grown::Detail;

constexpr std::array<double, 2> azimuths{0.3, 1.9};

double side_cover(const Model& model, const Case& c) {
  double sum = 0;
  for (const double azimuth : azimuths) sum += silhouette(model, c.height_m, c.radius_m, azimuth, false).share();
  return sum / azimuths.size();
}

double all_round_cover(const Model& model, const Case& c) {
  const double side = side_cover(model, c);
  return (2 * side + silhouette(model, c.height_m, c.radius_m, 0, true).share()) / 3;
}

// Shares of 10 x 10 blocks that are covered.
std::vector<double> blocks(const Silhouette& picture) {
  std::vector<double> shares(100);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.columns; ++x) {
      const std::size_t block = static_cast<std::size_t>(y * 10 / picture.rows * 10 + x * 10 / picture.columns);
      shares[block] += picture.covered[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.columns) +
                                       static_cast<std::size_t>(x)];
    }
  }
  for (double& share : shares) share *= 100.0 / static_cast<double>(picture.covered.size());
  return shares;
}

TEST(GrownCoverage, DetailsCoverAsMuch) {
  for (const Case& c : cases()) {
    double high = 0, medium = 0, least = 0;
    for (const std::uint64_t seed : {1u}) {
      high += all_round_cover(grown::grow(c.form, c.height_m, c.radius_m, seed, Detail::high), c);
      medium += all_round_cover(grown::grow(c.form, c.height_m, c.radius_m, seed, Detail::medium), c);
      least += all_round_cover(grown::grow(c.form, c.height_m, c.radius_m, seed, Detail::least), c);
    }
    EXPECT_NEAR(medium / high, 1, 0.12) << c.form.name;
    EXPECT_NEAR(least / high, 1, 0.12) << c.form.name;
  }
}

TEST(GrownCoverage, DetailsCoverTheSamePlaces) {
  for (const Case& c : cases()) {
    const Model high = grown::grow(c.form, c.height_m, c.radius_m, 1, Detail::high);
    const Model least = grown::grow(c.form, c.height_m, c.radius_m, 1, Detail::least);
    const Model other = grown::grow(c.form, c.height_m, c.radius_m, 2, Detail::least);
    const auto difference = [&](const Model& a, const Model& b) {
      const std::vector<double> x = blocks(silhouette(a, c.height_m, c.radius_m, 0, false)),
                                y = blocks(silhouette(b, c.height_m, c.radius_m, 0, false));
      double sum = 0, all = 0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        sum += std::abs(x[i] - y[i]);
        all += x[i];
      }
      return sum / all;
    };
    EXPECT_LT(difference(high, least), 0.28) << c.form.name;
    // Grass has no wood that would stay; of all others another seed is less alike than another detail.
    if (c.form.habit == grown::Habit::grass) continue;
    EXPECT_LT(difference(high, least), difference(high, other)) << c.form.name;
  }
}

TEST(GrownCoverage, DetailsHaveTheSameColour) {
  for (const Case& c : cases()) {
    const auto green = [&](Detail detail) {
      const Model model = grown::grow(c.form, c.height_m, c.radius_m, 1, detail);
      double sum = 0, count = 0;
      for (const std::uint16_t index : model.triangle_materials) {
        const Material& material = model.materials[index];
        if (!material.name.starts_with("leaf") && !material.name.starts_with("blade")) continue;
        static std::vector<double> means;
        if (count == 0) {
          means.clear();
          for (const Material& m : model.materials) means.push_back(seen(model, m).green);
        }
        sum += means[index];
        ++count;
      }
      return sum / count;
    };
    const double high = green(Detail::high);
    EXPECT_NEAR(green(Detail::medium) / high, 1, 0.12) << c.form.name;
    EXPECT_NEAR(green(Detail::least) / high, 1, 0.12) << c.form.name;
  }
}

// Neither a ball nor a broom: the crown's outline is mostly covered, and light comes through.
TEST(GrownCoverage, CrownsHaveGaps) {
  for (const Case& c : cases()) {
    if (c.form.habit != grown::Habit::woody) continue;
    const Model model = grown::grow(c.form, c.height_m, c.radius_m, 1, Detail::high);
    const Silhouette picture = silhouette(model, c.height_m, c.radius_m, 0.3, false);
    // Row by row between the outermost covered cells.
    double inside = 0, gaps = 0;
    for (int y = 0; y < picture.rows * (1 - c.form.crown_base); ++y) {
      int first = -1, last = -1;
      const auto at = [&](int x) {
        return picture.covered[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.columns) +
                               static_cast<std::size_t>(x)];
      };
      for (int x = 0; x < picture.columns; ++x) {
        if (!at(x)) continue;
        if (first < 0) first = x;
        last = x;
      }
      for (int x = std::max(0, first); x <= last; ++x) {
        inside += 1;
        gaps += at(x) ? 0 : 1;
      }
    }
    EXPECT_GT(gaps / inside, 0.04) << c.form.name;
    EXPECT_LT(gaps / inside, 0.65) << c.form.name;
  }
}

}  // namespace
}  // namespace assets::grown_tests
