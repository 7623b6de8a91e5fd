#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ghosttile/cover/fillers.h"
#include "land.h"

namespace ghosttile::cover::test {

namespace {

constexpr std::size_t nodes = static_cast<std::size_t>(block_nodes) * block_nodes;

// Compares a filler at random nodes with a truth that looks at all plants.
void expect_at_nodes(const Filler& filler, const Plants& plants, double step_m, Random& random, double tolerance,
                     const std::function<double(double, double)>& truth, int checks) {
  const NodeBlock block = block_near(random_place(random, grown(plants.ecosystem().extent, 5)), step_m);
  std::vector<float> values(nodes);
  filler.fill(block, values.data());
  for (int k = 0; k < checks; ++k) {
    const int i = static_cast<int>(random() % block_nodes), j = static_cast<int>(random() % block_nodes);
    const double expected = truth(block.x(i), block.y(j));
    ASSERT_NEAR(values[static_cast<std::size_t>(j * block_nodes + i)], expected, tolerance * std::max(1.0, expected))
        << "at " << i << ", " << j;
  }
}

TEST(CrownCover, IsWhatAllCrownsTogetherLeaveOpen) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto plants = std::make_shared<const Plants>(random_ecosystem(random));
    const std::vector<Stem> all = all_stems(*plants);
    const Chosen chosen = choose(plants, [&](const PlantSpecies&) { return random() % 3 > 0; });
    CrownCover cover{static_cast<float>(between(random, 0, 3)), static_cast<float>(between(random, 0.05, 1)), {}};
    for (std::size_t s = 0; s < plants->species().size(); ++s)
      cover.strength.push_back(static_cast<float>(between(random, 0, 1)));
    const auto truth = [&](double x, double y) {
      double open = 1;
      for (const Stem& stem : all) {
        if (!chosen.selection.species[stem.species]) continue;
        const double radius = static_cast<double>(stem.radius_m), rim = static_cast<double>(cover.rim);
        const double from = radius * (1 - rim), until = radius + static_cast<double>(cover.reach_m);
        const double t = std::clamp((std::hypot(x - stem.x_m, y - stem.y_m) - from) / (until - from), 0.0, 1.0);
        open *= 1 - static_cast<double>(cover.strength[stem.species]) * (1 - t * t * (3 - 2 * t));
      }
      return 1 - open;
    };
    expect_at_nodes(*crown_cover(chosen, cover), *plants, 0.25, random, 2e-5, truth, 300);
  }
}

TEST(CrownCover, IsOneInsideAndNothingOutside) {
  const CrownCover cover{0, 0.25f, {}};
  EXPECT_EQ(crown_cover_at(0, 4, cover), 1);
  EXPECT_EQ(crown_cover_at(3, 4, cover), 1);
  EXPECT_EQ(crown_cover_at(3.5f, 4, cover), 0.5f);
  EXPECT_EQ(crown_cover_at(4, 4, cover), 0);
  EXPECT_EQ(crown_cover_at(4.9f, 4, {1, 0, {}}) > 0, true);
  EXPECT_EQ(crown_cover_at(4, 4, {0, 0, {}}), 1);  // no rim, no reach: a disc
  EXPECT_EQ(crown_cover_at(4.0001f, 4, {0, 0, {}}), 0);
}

TEST(StemDistance, IsThatOfTheNearestOfAll) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto plants = std::make_shared<const Plants>(random_ecosystem(random));
    const std::vector<Stem> all = all_stems(*plants);
    const Chosen chosen = choose(plants, [&](const PlantSpecies&) { return random() % 3 == 0; });
    const double most = between(random, 1, 12);
    const auto truth = [&](double x, double y) {
      double least = most;
      for (const Stem& stem : all) {
        if (chosen.selection.species[stem.species]) least = std::min(least, std::hypot(x - stem.x_m, y - stem.y_m));
      }
      return least;
    };
    expect_at_nodes(*stem_distance(chosen, static_cast<float>(most)), *plants, 0.25, random, 1e-5, truth, 300);
  }
}

TEST(StandDensity, CountsStemsAndBasalArea) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto plants = std::make_shared<const Plants>(random_ecosystem(random));
    const std::vector<Stem> all = all_stems(*plants);
    const Chosen chosen = choose(plants, [&](const PlantSpecies&) { return random() % 3 > 0; });
    const double radius = between(random, 3, 20);
    const bool area = seed % 2 == 0;
    const auto truth = [&](double x, double y) {
      double sum = 0;
      for (const Stem& stem : all) {
        if (!chosen.selection.species[stem.species]) continue;
        const double share = std::hypot(x - stem.x_m, y - stem.y_m) / radius, thick = plants->stem_radius_m(stem);
        sum += std::max(0.0, 1 - share * share) * (area ? M_PI * thick * thick : 1);
      }
      return sum * 2e4 / (M_PI * radius * radius);
    };
    expect_at_nodes(
        *stand_density(chosen, static_cast<float>(radius), area ? DensityMeasure::basal_area : DensityMeasure::stems),
        *plants, 0.5, random, 1e-4, truth, 200);
  }
}

// The kernel has the integral 1: the mean over a land that holds all stems' discs is their number over its area.
TEST(StandDensity, HasTheMeanThatThereIs) {
  Random random(9);
  const auto plants = std::make_shared<const Plants>(random_ecosystem(random));
  const Chosen chosen = choose(plants, [](const PlantSpecies& s) { return s.layer == 0; });
  double stems = 0, sum = 0;
  for (const Stem& stem : all_stems(*plants)) stems += plants->species()[stem.species].layer == 0 ? 1 : 0;
  const auto filler = stand_density(chosen, 6, DensityMeasure::stems);
  std::vector<float> values(nodes);
  const Box box = grown(plants->ecosystem().extent, 8);
  const NodeBlock first = block_near({box.west, box.south}, 0.5);
  for (std::int64_t row = first.first_row; static_cast<double>(row) * 0.5 < box.north; row += block_cells) {
    for (std::int64_t column = first.first_column; static_cast<double>(column) * 0.5 < box.east;
         column += block_cells) {
      filler->fill({column, row, 0.5}, values.data());
      for (int j = 0; j < block_cells; ++j) {
        for (int i = 0; i < block_cells; ++i)
          sum += static_cast<double>(values[static_cast<std::size_t>(j * block_nodes + i)]) * 0.25 / 1e4;
      }
    }
  }
  EXPECT_NEAR(sum, stems, 0.01 * stems);
}

// How much of a ray lies in a crown, by walking along it; the sky by 10,000 directions instead of 29.
TEST(Light, IsWhatRaysBringThroughTheCrowns) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto plants = std::make_shared<const Plants>(random_ecosystem(random));
    const std::vector<Stem> all = all_stems(*plants);
    const Chosen chosen = choose_all(plants);
    const double month = between(random, 1, 13);
    Light settings;
    settings.month = month;
    settings.leaf_area = 3;
    const auto filler = light(chosen, settings);
    const auto truth = [&](double x, double y) {
      double sum = 0, weights = 0;
      for (int k = 0; k < 2000; ++k) {
        // Uniform over the upper half of the sphere down to 10 degrees, by the golden angle.
        const double up = 1 - (1 - std::cos(80 * M_PI / 180)) * (k + 0.5) / 2000, aside = std::sqrt(1 - up * up);
        const double dx = aside * std::cos(2.399963 * k), dy = aside * std::sin(2.399963 * k);
        double depth = 0;
        for (const Stem& stem : all) {
          const PlantSpecies& species = plants->species()[stem.species];
          const double height = plants->height_m(stem), radius = static_cast<double>(stem.radius_m);
          const double half = 0.5 * height * (height < 5 ? 0.9 : species.habit.needles ? 0.7 : 0.6);
          const double leaves = 0.5 * 3 * 3 / (4 * half) * static_cast<double>(foliage(species.habit, month));
          // Walk where the ray is as high as the crown.
          const double first = std::max(0.0, (height - 2 * half) / up), last = height / up, step = (last - first) / 24;
          const double mid = (first + last) / 2;
          if (std::hypot(x + mid * dx - stem.x_m, y + mid * dy - stem.y_m) > radius + (last - first) * aside) continue;
          for (int s = 0; s < 24; ++s) {
            const double t = first + (s + 0.5) * step;
            const double u = (x + t * dx - stem.x_m) / radius, v = (y + t * dy - stem.y_m) / radius,
                         w = (t * up - height + half) / half;
            if (u * u + v * v + w * w < 1) depth += leaves * step;
          }
        }
        const double weight = (1 + 2 * up) * up;
        sum += weight * std::exp(-depth);
        weights += weight;
      }
      return sum / weights;
    };
    const NodeBlock block = block_near(random_place(random, plants->ecosystem().extent), 0.5);
    std::vector<float> values(nodes);
    filler->fill(block, values.data());
    double off = 0, mean = 0, spread = 0, squared = 0;
    constexpr int checks = 60;
    for (int k = 0; k < checks; ++k) {
      const int i = static_cast<int>(random() % block_nodes), j = static_cast<int>(random() % block_nodes);
      const double expected = truth(block.x(i), block.y(j));
      const double got = static_cast<double>(values[static_cast<std::size_t>(j * block_nodes + i)]);
      off += got - expected;
      squared += (got - expected) * (got - expected);
      mean += expected;
      spread += expected * expected;
    }
    mean /= checks;
    spread = std::sqrt(spread / checks - mean * mean);
    std::printf("light: mean %.3f, spread %.3f, bias %.4f, rms error %.4f\n", mean, spread, off / checks,
                std::sqrt(squared / checks));
    // 29 rays scatter around the truth, without a bias and by less than the land varies.
    EXPECT_NEAR(off / checks, 0, 0.015);
    EXPECT_LT(std::sqrt(squared / checks), 0.05);
    EXPECT_LT(mean, 0.95);
  }
}

TEST(Light, IsFullWhereNothingStands) {
  Random random(2);
  const auto plants = std::make_shared<const Plants>(random_ecosystem(random));
  const auto filler = light(choose_all(plants), {});
  std::vector<float> values(nodes);
  const Box& extent = plants->ecosystem().extent;
  const NodeBlock block = block_near({extent.east + 500, extent.north + 500}, 0.5);
  filler->fill(block, values.data());
  const Range range = filler->range(block.box());
  for (const float value : values) ASSERT_EQ(value, range.least);
  EXPECT_EQ(range.least, range.most);
  EXPECT_NEAR(range.least, 1, 1e-5);
}

// A node's value may not depend on the block that it was worked out in.
TEST(Fillers, GiveTheSameAtNodesThatBlocksShare) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto plants = std::make_shared<const Plants>(random_ecosystem(random));
    const Chosen chosen = choose_all(plants);
    std::vector<std::unique_ptr<const Filler>> fillers;
    fillers.push_back(crown_cover(chosen, {1.3f, 0.25f, {}}));
    fillers.push_back(stem_distance(chosen, 5));
    fillers.push_back(stand_density(chosen, 9, DensityMeasure::basal_area));
    fillers.push_back(light(chosen, {}));
    fillers.push_back(patches(seed, 2.3));
    for (std::size_t f = 0; f < fillers.size(); ++f) {
      const NodeBlock one = block_near(random_place(random, plants->ecosystem().extent), 0.25);
      const int aside = static_cast<int>(random() % block_nodes), up = static_cast<int>(random() % block_nodes);
      const NodeBlock other{one.first_column + aside, one.first_row - up, 0.25};
      std::vector<float> a(nodes), b(nodes);
      fillers[f]->fill(one, a.data());
      fillers[f]->fill(other, b.data());
      for (int j = 0; j + up < block_nodes; ++j) {
        for (int i = 0; i + aside < block_nodes; ++i) {
          ASSERT_EQ(a[static_cast<std::size_t>(j * block_nodes + i + aside)],
                    b[static_cast<std::size_t>((j + up) * block_nodes + i)])
              << "filler " << f;
        }
      }
    }
  }
}

TEST(Patches, AreEvenlySpreadAndAsWideAsAsked) {
  const auto filler = patches(7, 4);
  std::vector<float> values(nodes);
  double sum = 0, squared = 0, steps = 0;
  for (std::int64_t k = 0; k < 40; ++k) {
    filler->fill({k * 640, -k * 64, 0.25}, values.data());
    for (std::size_t i = 0; i + 16 < nodes; ++i) {
      ASSERT_GE(values[i], 0);
      ASSERT_LE(values[i], 1);
      const double v = static_cast<double>(values[i]) - 0.5;
      sum += v;
      squared += v * v;
      steps += std::fabs(static_cast<double>(values[i + 1] - values[i]));
    }
  }
  const double count = 40.0 * static_cast<double>(nodes - 16);
  EXPECT_NEAR(sum / count, 0, 0.02);
  EXPECT_GT(std::sqrt(squared / count), 0.12);
  EXPECT_LT(steps / count, 0.08);  // smooth at a sixteenth of the width
}

}  // namespace

}  // namespace ghosttile::cover::test
