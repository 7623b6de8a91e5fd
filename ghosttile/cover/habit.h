// What is known of a plant by its name: leaves or needles, and what the seasons do to them.
//
// Genera, as far as they are not broadleaved and deciduous, stand in a table; all others are taken to be that.
// Months: 1 is the beginning of January, 10.5 the middle of October, 13 the end of December.
#pragma once

#include <string>

namespace ghosttile::cover {

struct Habit {
  bool needles = false;
  bool evergreen = false;
  float decay_a_year = 0.7f;  // k of Olson 1963, exp(-k t): how fast its litter goes
};

Habit habit_of(const std::string& species);

// "Quercus" of "Quercus robur"
std::string genus_of(const std::string& species);

// Share of the leaves that are on the crown, in [0, 1].
float foliage(const Habit& habit, double month);

// Litter on the ground against the year's most, in (0, 1]: what falls by month, less what decays; the same from year to year.
float litter(const Habit& habit, double month);

}  // namespace ghosttile::cover
