#include "ghosttile/cover/habit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace ghosttile::cover {
namespace {

TEST(Habit, IsKnownByGenus) {
  EXPECT_TRUE(habit_of("Picea abies").needles);
  EXPECT_TRUE(habit_of("Picea abies").evergreen);
  EXPECT_TRUE(habit_of("Larix decidua").needles);
  EXPECT_FALSE(habit_of("Larix decidua").evergreen);
  EXPECT_FALSE(habit_of("Fagus sylvatica").needles);
  EXPECT_FALSE(habit_of("Fagus sylvatica").evergreen);
  EXPECT_TRUE(habit_of("Quercus ilex").evergreen);
  EXPECT_FALSE(habit_of("Quercus robur").evergreen);
  EXPECT_FALSE(habit_of("Something else").needles);
}

TEST(Foliage, ComesInSpringAndGoesInAutumn) {
  const Habit beech = habit_of("Fagus sylvatica");
  EXPECT_FLOAT_EQ(foliage(beech, 7.5), 1);
  EXPECT_FLOAT_EQ(foliage(beech, 1.2), 0.15f);
  EXPECT_FLOAT_EQ(foliage(beech, 12.9), foliage(beech, 1.1));  // the year closes
  EXPECT_GT(foliage(beech, 10), foliage(beech, 11));
  EXPECT_FLOAT_EQ(foliage(habit_of("Abies alba"), 1.2), 1);
}

// Day by day for a hundred years: leaves fall, litter decays.
TEST(Litter, IsWhatFallsAndDecaysDayByDay) {
  const double fall[12] = {0.01, 0.01, 0.01, 0.01, 0.01, 0.02, 0.02, 0.03, 0.08, 0.40, 0.36, 0.04};
  for (const char* name : {"Fagus sylvatica", "Fraxinus excelsior", "Picea abies", "Sambucus nigra", "Larix decidua"}) {
    const Habit habit = habit_of(name);
    std::vector<double> year(1200);
    double amount = 0;
    for (int cycle = 0; cycle < 100; ++cycle) {
      for (std::size_t step = 0; step < 1200; ++step) {
        year[step] = amount;
        amount += (habit.evergreen ? 1.0 / 12 : fall[step / 100]) / 100;
        amount *= std::exp(-static_cast<double>(habit.decay_a_year) / 1200);
      }
    }
    double most = 0;
    for (std::size_t m = 0; m < 12; ++m) most = std::max(most, year[m * 100 + 50]);
    for (std::size_t m = 0; m < 12; ++m) {
      EXPECT_NEAR(litter(habit, 1.5 + static_cast<double>(m)), year[m * 100 + 50] / most, 0.02)
          << name << ", month " << m + 1;
    }
  }
}

TEST(Litter, LiesMostInLateAutumnAndLongUnderBeech) {
  const Habit beech = habit_of("Fagus sylvatica"), ash = habit_of("Fraxinus excelsior");
  EXPECT_GT(litter(beech, 11.5), litter(beech, 9));
  EXPECT_GT(litter(beech, 12), litter(beech, 6));
  EXPECT_GT(litter(beech, 8.5), litter(ash, 8.5) + 0.2f);
  for (double month = 1; month < 13; month += 0.1) {
    EXPECT_GT(litter(ash, month), 0);
    EXPECT_LE(litter(ash, month), 1);
    EXPECT_NEAR(litter(habit_of("Picea abies"), month), 1, 0.01);
  }
}

}  // namespace
}  // namespace ghosttile::cover
