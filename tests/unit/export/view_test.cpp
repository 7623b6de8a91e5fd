#include "silvasim/export/view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "made_land.h"
#include "silvasim/base/error.h"
#include "silvasim/base/random.h"

namespace silvasim::exports {
namespace {

using ::testing::HasSubstr;
using testing::MadeLand;
using testing::make_land;
using testing::recount;

std::string message_of(auto&& call) {
  try {
    call();
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "no base::ConfigError";
}

TEST(View, census_equals_a_recount_in_any_box) {
  constexpr std::uint64_t seed = 11;
  MadeLand made;
  ecosystem::Ecosystem land = make_land(made);
  add_shrubs(land, made);
  base::Stream random(seed, base::Purpose::selection);
  for (int round = 0; round < 40; ++round) {
    PreviewOptions options;
    if (round > 0) {
      const double x = land.extent.west - 50 + random.next_double() * land.extent.width();
      const double y = land.extent.south - 50 + random.next_double() * land.extent.height();
      options.bbox = base::Box{x, y, x + 60 + 300 * random.next_double(), y + 60 + 300 * random.next_double()};
    }
    const base::Box box = box_of(land, options);
    const Census census = take_census(land, options, box);
    std::uint64_t all = 0;
    for (std::size_t l = 0; l < land.layers.size(); ++l) {
      for (std::size_t s = 0; s < land.layers[l].species.size(); ++s) {
        EXPECT_EQ(census.layers[l][s].plants, recount(land, l, s, box)) << "seed " << seed << " round " << round;
        all += census.layers[l][s].plants;
      }
    }
    EXPECT_EQ(census.plants, all);
    EXPECT_GT(all, 0u);
  }
}

TEST(View, plants_near_a_box_are_all_that_lie_in_it_once_and_in_order) {
  MadeLand made;
  const ecosystem::Ecosystem land = make_land(made);
  const ecosystem::Layer& layer = land.layers[0];
  const auto offsets = ecosystem::site_offsets(layer.tile_set, layer.tiling);
  const double side = made.side_m;
  // Boxes on, just beside and far from the tiles' borders.
  for (const base::Box& box :
       {land.extent, base::grown(land.extent, 1e7),
        base::Box{land.extent.west + side, land.extent.south + side, land.extent.west + 2 * side,
                  land.extent.south + 2 * side},
        base::Box{land.extent.west + 0.1, land.extent.south + 0.1, land.extent.west + 0.2, land.extent.south + 0.2},
        base::Box{0, 0, 1, 1}}) {
    std::vector<std::size_t> wanted, found;
    const auto index = [&](const ecosystem::Plant& plant) {
      return offsets[static_cast<std::size_t>(plant.row * layer.tiling.columns + plant.column)] + plant.site;
    };
    ecosystem::for_each_plant(layer, offsets, 0, layer.tiling.rows, [&](const ecosystem::Plant& plant) {
      if (box.contains(plant.at)) wanted.push_back(index(plant));
    });
    for_each_plant_near(layer, offsets, box, [&](const ecosystem::Plant& plant) {
      if (box.contains(plant.at)) found.push_back(index(plant));
    });
    EXPECT_EQ(found, wanted);
  }
}

TEST(View, species_are_found_by_either_name_and_misspelt_ones_corrected) {
  const ecosystem::Ecosystem land = make_land({});
  PreviewOptions options;
  options.species = {"Picea abies", "European larch"};
  const Census census = take_census(land, options, land.extent);
  EXPECT_TRUE(census.layers[0][0].shown);
  EXPECT_FALSE(census.layers[0][1].shown);
  EXPECT_TRUE(census.layers[0][2].shown);
  EXPECT_EQ(census.plants, census.layers[0][0].plants + census.layers[0][2].plants);

  options.species = {"Picea abis"};
  EXPECT_THAT(message_of([&] { take_census(land, options, land.extent); }),
              HasSubstr("no species \"Picea abis\"; did you mean \"Picea abies\"?"));
  options.species = {"xyzzy"};
  EXPECT_THAT(message_of([&] { take_census(land, options, land.extent); }), HasSubstr("it has \"Picea abies\""));
}

TEST(View, probabilities_that_are_not_there_tell_how_to_get_them) {
  MadeLand made;
  made.probabilities = false;
  const ecosystem::Ecosystem land = make_land(made);
  PreviewOptions options;
  options.subject = Subject::probability;
  EXPECT_THAT(message_of([&] { take_census(land, options, land.extent); }), HasSubstr("--probabilities"));
}

TEST(View, mean_probability_is_the_mean) {
  const ecosystem::Ecosystem land = make_land({});
  PreviewOptions options;
  options.subject = Subject::probability;
  const Census census = take_census(land, options, land.extent);
  std::map<int, std::pair<double, int>> sums;
  const ecosystem::Layer& layer = land.layers[0];
  for (std::size_t i = 0; i < layer.plants.size(); ++i) {
    if (layer.plants[i] == ecosystem::no_plant) continue;
    sums[layer.plants[i]].first += layer.probabilities[i] / 65535.0;
    sums[layer.plants[i]].second += 1;
  }
  for (const auto& [species, sum] : sums) {
    EXPECT_NEAR(census.layers[0][static_cast<std::size_t>(species)].mean_probability, sum.first / sum.second, 1e-6);
  }
}

TEST(View, a_box_without_land_names_both) {
  const ecosystem::Ecosystem land = make_land({});
  PreviewOptions options;
  options.bbox = base::Box{0, 0, 10, 10};
  EXPECT_THAT(message_of([&] { box_of(land, options); }),
              ::testing::AllOf(HasSubstr("--bbox"), HasSubstr("0 to 10 east"), HasSubstr("600000 to 600600 east")));
  options.bbox = base::Box{10, 0, 0, 10};
  EXPECT_THAT(message_of([&] { box_of(land, options); }), HasSubstr("west < east"));
}

}  // namespace
}  // namespace silvasim::exports
