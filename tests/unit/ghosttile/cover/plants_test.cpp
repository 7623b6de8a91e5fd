#include "ghosttile/cover/plants.h"

#include <algorithm>

#include "land.h"

namespace ghosttile::cover::test {

namespace {

bool same(const Stem& a, const Stem& b) {
  return a.x_m == b.x_m && a.y_m == b.y_m && a.radius_m == b.radius_m && a.species == b.species;
}
bool before(const Stem& a, const Stem& b) {
  return std::tie(a.species, a.x_m, a.y_m, a.radius_m) < std::tie(b.species, b.x_m, b.y_m, b.radius_m);
}

TEST(Plants, AreThoseThatALookAtAllOfThemFinds) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto plants = std::make_shared<const Plants>(random_ecosystem(random));
    const std::vector<Stem> all = all_stems(*plants);
    ASSERT_GT(all.size(), 100u);
    const Chosen chosen = choose(plants, [&](const PlantSpecies&) { return random() % 2 == 0; });
    for (int round = 0; round < 50; ++round) {
      // From a hand's width to more than the land, also beside it.
      const auto corner = random_place(random, grown(plants->ecosystem().extent, 60));
      const double size = std::pow(10, between(random, -1, 2.6));
      const Box box{corner.x, corner.y, corner.x + size, corner.y + size * between(random, 0.2, 2)};
      std::vector<Stem> found, expected;
      std::vector<bool> any(plants->layer_count(), false);
      for (std::size_t l = 0; l < plants->layer_count(); ++l) {
        plants->for_each(l, box, chosen.selection, [&](const Stem& stem) {
          found.push_back(stem);
          return true;
        });
      }
      for (const Stem& stem : all) {
        if (!box.contains({stem.x_m, stem.y_m}) || !chosen.selection.species[stem.species]) continue;
        expected.push_back(stem);
        any[plants->species()[stem.species].layer] = true;
      }
      std::sort(found.begin(), found.end(), before);
      std::sort(expected.begin(), expected.end(), before);
      ASSERT_TRUE(std::equal(found.begin(), found.end(), expected.begin(), expected.end(), same))
          << found.size() << " against " << expected.size();
      for (std::size_t l = 0; l < plants->layer_count(); ++l) ASSERT_EQ(plants->any(l, box, chosen.selection), any[l]);
    }
  }
}

TEST(Plants, ComeInOneOrderWhateverTheBox) {
  Random random(3);
  const auto plants = std::make_shared<const Plants>(random_ecosystem(random));
  const Chosen chosen = choose_all(plants);
  std::vector<Stem> whole;
  plants->for_each(0, grown(plants->ecosystem().extent, 100), chosen.selection, [&](const Stem& stem) {
    whole.push_back(stem);
    return true;
  });
  for (int round = 0; round < 50; ++round) {
    const auto corner = random_place(random, plants->ecosystem().extent);
    const Box box{corner.x, corner.y, corner.x + 40, corner.y + 40};
    auto next = whole.begin();
    plants->for_each(0, box, chosen.selection, [&](const Stem& stem) {
      while (next != whole.end() && !same(*next, stem)) ++next;
      EXPECT_NE(next, whole.end());
      return true;
    });
  }
}

TEST(Plants, KnowTheMostOfTheirSelection) {
  Random random(4);
  const auto plants = std::make_shared<const Plants>(random_ecosystem(random));
  const Chosen oaks = choose(plants, [](const PlantSpecies& s) { return genus_of(s.name) == "Quercus"; });
  float most = 0;
  for (const Stem& stem : all_stems(*plants)) {
    if (genus_of(plants->species()[stem.species].name) == "Quercus") most = std::max(most, stem.radius_m);
  }
  EXPECT_EQ(oaks.selection.layers[0].most_radius_m, most);
  EXPECT_EQ(oaks.selection.layers[1].most_radius_m, 0);
}

TEST(Plants, TakeStemsFromTheScenario) {
  Random random(5);
  const auto ecosystem = random_ecosystem(random);
  silvasim::config::Scenario scenario;
  scenario.layers.resize(1);
  scenario.layers[0].name = "trees";
  scenario.layers[0].species.resize(1);
  scenario.layers[0].species[0].name = "Quercus robur";
  scenario.layers[0].species[0].height_m = 20;
  scenario.layers[0].species[0].stem_radius_m = 0.5;
  const Plants plants(ecosystem, &scenario);
  for (const PlantSpecies& species : plants.species()) {
    EXPECT_FLOAT_EQ(species.stem_per_height, species.name == "Quercus robur" ? 0.025f : Plants::usual_stem_per_height);
  }
}

}  // namespace

}  // namespace ghosttile::cover::test
