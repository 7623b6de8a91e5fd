// The year of leaves in central Europe. Leaves and their fall by month: rounded from the phenology of beech and oak (leaves
// out by the middle of May, nine tenths down between October and the middle of November; Leuschner and Ellenberg 2017).
// Decay: rounded by hand, no measurement. The order is what Cornelissen 1996 and Hobbie et al. 2006 find: ash, elder, alder, lime and
// maple go fast, oak, beech and needles slowly.
#include "ghosttile/cover/habit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "silvasim/base/math.h"

namespace ghosttile::cover {

namespace {

using Year = std::array<double, 12>;  // at the middle of each month, or of the whole month

constexpr Year leaves = {0, 0, 0, 0.2, 0.85, 1, 1, 1, 0.95, 0.6, 0.1, 0};
constexpr Year leaf_fall = {0.01, 0.01, 0.01, 0.01, 0.01, 0.02, 0.02, 0.03, 0.08, 0.40, 0.36, 0.04};
constexpr double bare_wood = 0.15;  // twigs and stems shade as this share of the leaves do

struct Genus {
  const char* name;
  Habit habit;
};
constexpr Genus genera[] = {
    {"Abies", {true, true, 0.3f}},       {"Picea", {true, true, 0.3f}},       {"Pinus", {true, true, 0.3f}},
    {"Pseudotsuga", {true, true, 0.3f}}, {"Tsuga", {true, true, 0.3f}},       {"Taxus", {true, true, 0.4f}},
    {"Juniperus", {true, true, 0.3f}},   {"Thuja", {true, true, 0.3f}},       {"Chamaecyparis", {true, true, 0.3f}},
    {"Cupressus", {true, true, 0.3f}},   {"Cedrus", {true, true, 0.3f}},      {"Sequoia", {true, true, 0.3f}},
    {"Calocedrus", {true, true, 0.3f}},  {"Cryptomeria", {true, true, 0.3f}}, {"Sequoiadendron", {true, true, 0.3f}},
    {"Larix", {true, false, 0.3f}},      {"Taxodium", {true, false, 0.3f}},   {"Metasequoia", {true, false, 0.3f}},
    {"Ilex", {false, true, 0.6f}},       {"Buxus", {false, true, 0.6f}},      {"Hedera", {false, true, 0.7f}},
    {"Arbutus", {false, true, 0.4f}},    {"Laurus", {false, true, 0.5f}},     {"Olea", {false, true, 0.5f}},
    {"Eucalyptus", {false, true, 0.4f}}, {"Calluna", {false, true, 0.3f}},    {"Rhododendron", {false, true, 0.4f}},
    {"Gaultheria", {false, true, 0.4f}}, {"Mahonia", {false, true, 0.5f}},    {"Fagus", {false, false, 0.4f}},
    {"Quercus", {false, false, 0.45f}},  {"Populus", {false, false, 0.6f}},   {"Betula", {false, false, 0.7f}},
    {"Carpinus", {false, false, 0.9f}},  {"Corylus", {false, false, 0.9f}},   {"Acer", {false, false, 1.0f}},
    {"Tilia", {false, false, 1.2f}},     {"Alnus", {false, false, 1.3f}},     {"Ulmus", {false, false, 1.3f}},
    {"Fraxinus", {false, false, 1.6f}},  {"Sambucus", {false, false, 2.0f}},
};
constexpr const char* evergreen_oaks[] = {"Quercus ilex", "Quercus suber", "Quercus coccifera", "Quercus chrysolepis"};

// Straight lines between the middles of the months, around the year.
double at_month(const Year& year, double month) {
  const double place = month - 1.5 - 12 * std::floor((month - 1.5) / 12);  // [0, 12]: 0 is the middle of January
  const auto before = std::min<std::size_t>(static_cast<std::size_t>(place), 11);
  const double share = place - static_cast<double>(before);
  return year[before] + share * (year[(before + 1) % 12] - year[before]);
}

}  // namespace

std::string genus_of(const std::string& species) { return species.substr(0, species.find(' ')); }

Habit habit_of(const std::string& species) {
  Habit habit;
  const std::string genus = genus_of(species);
  for (const Genus& known : genera) {
    if (genus == known.name) habit = known.habit;
  }
  for (const char* oak : evergreen_oaks) habit.evergreen = habit.evergreen || species == oak;
  return habit;
}

float foliage(const Habit& habit, double month) {
  if (habit.evergreen) return 1;
  return static_cast<float>(bare_wood + (1 - bare_wood) * at_month(leaves, month));
}

float litter(const Habit& habit, double month) {
  // Half of a month's fall decays for half of the month. Start with what is left of all the years before: a geometric series.
  const double left = silvasim::base::exp(-static_cast<double>(habit.decay_a_year) / 12);
  Year ground{};
  double amount = 0;
  for (int round = 0; round < 2; ++round) {
    if (round == 1) {
      double year_left = 1;
      for (int m = 0; m < 12; ++m) year_left *= left;
      amount /= 1 - year_left;
    }
    for (std::size_t m = 0; m < 12; ++m) {
      const double fall = habit.evergreen ? 1.0 / 12 : leaf_fall[m];
      ground[m] = (amount + fall / 2) * (1 + left) / 2;
      amount = amount * left + fall * (1 + left) / 2;
    }
  }
  const double most = *std::max_element(ground.begin(), ground.end());
  return static_cast<float>(at_month(ground, month) / most);
}

}  // namespace ghosttile::cover
