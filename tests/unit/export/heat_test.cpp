#include "silvasim/export/heat.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "files.h"
#include "made_land.h"
#include "silvasim/base/error.h"
#include "silvasim/base/parallel.h"
#include "silvasim/export/colour.h"
#include "silvasim/export/ground.h"
#include "silvasim/export/layout.h"

namespace silvasim::exports {
namespace {

using ::testing::HasSubstr;
using testing::MadeLand;
using testing::make_land;

constexpr std::uint8_t no_site = ecosystem::SuitabilityMap::no_site;

PreviewOptions of_place(std::vector<std::string> species = {}) {
  PreviewOptions options;
  options.subject = Subject::suitability;
  options.species = std::move(species);
  return options;
}

Heat heat_of(const ecosystem::Ecosystem& land, const PreviewOptions& options) {
  return Heat(land, take_census(land, options, land.extent));
}

// Every cell of a species' map the same.
void fill(ecosystem::Ecosystem& land, std::size_t layer, std::size_t species, std::uint8_t share) {
  ecosystem::SuitabilityMap& map = land.layers[layer].suitability;
  std::fill_n(map.shares.begin() + static_cast<std::ptrdiff_t>(species) * map.columns * map.rows,
              map.columns * map.rows, share);
}

std::uint8_t& cell(ecosystem::Ecosystem& land, std::size_t species, int column, int row) {
  ecosystem::SuitabilityMap& map = land.layers[0].suitability;
  return map.shares[(species * static_cast<std::size_t>(map.rows) + static_cast<std::size_t>(row)) *
                        static_cast<std::size_t>(map.columns) +
                    static_cast<std::size_t>(column)];
}

base::Point centre(const ecosystem::Ecosystem& land, int column, int row) {
  const ecosystem::SuitabilityMap& map = land.layers[0].suitability;
  return {map.west + (column + 0.5) * map.cell_m, map.north - (row + 0.5) * map.cell_m};
}

TEST(Heat, is_the_largest_of_the_shown_species) {
  ecosystem::Ecosystem land = make_land({});
  testing::add_shrubs(land, {});
  const std::uint8_t shares[] = {50, 100, 20};
  for (std::size_t s = 0; s < 3; ++s) fill(land, 0, s, shares[s]);
  fill(land, 1, 0, 0);
  fill(land, 1, 1, 200);
  const auto at = [&](std::vector<std::string> species) {
    const Heat::Sample sample = heat_of(land, of_place(std::move(species))).at(land.extent.west + 7, land.extent.north);
    return std::lround(sample.share * 254 * std::min(sample.opacity, 1.0f));
  };
  EXPECT_EQ(at({"Picea abies"}), 50);
  EXPECT_EQ(at({"Picea abies", "Larix decidua"}), 50);
  EXPECT_EQ(at({"Picea abies", "Fagus sylvatica"}), 100);
  EXPECT_EQ(at({}), 200);
  EXPECT_EQ(at({"Bilberry"}), 0);
}

TEST(Heat, cells_without_sites_or_growth_darken_no_neighbour) {
  for (const int hole : {0, int{no_site}}) {
    ecosystem::Ecosystem land = make_land({});
    fill(land, 0, 0, 127);
    for (int row = 4; row < 10; ++row) {
      for (int column = 4; column < 10; ++column) cell(land, 0, column, row) = static_cast<std::uint8_t>(hole);
    }
    const Heat heat = heat_of(land, of_place({"Picea abies"}));
    double least = 1;
    for (double x = land.extent.west + 1; x < land.extent.west + 300; x += 3.1) {
      for (double y = land.extent.north - 1; y > land.extent.north - 300; y -= 3.1) {
        const Heat::Sample sample = heat.at(x, y);
        least = std::min<double>(least, sample.opacity);
        if (sample.opacity <= 0) continue;
        ASSERT_NEAR(sample.share, 0.5, 1e-5) << x << " " << y;
      }
    }
    // Where nothing can grow the ground shows; where nobody knows the neighbours tell.
    EXPECT_EQ(least, hole == 0 ? 0 : 1);
  }
}

TEST(Heat, a_line_of_cells_stays_whole) {
  ecosystem::Ecosystem land = make_land({});
  for (const bool slanted : {false, true}) {
    fill(land, 0, 0, 0);
    for (int i = 2; i < 20; ++i) cell(land, 0, i, slanted ? i : 5) = 200;
    const Heat heat = heat_of(land, of_place({"Picea abies"}));
    const base::Point from = centre(land, 3, slanted ? 3 : 5), to = centre(land, 18, slanted ? 18 : 5);
    for (double t = 0; t <= 1; t += 0.01) {
      EXPECT_GT(heat.at(from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)).opacity, 0.5f) << t;
    }
  }
}

TEST(Heat, mean_suitability_is_the_mean_of_the_box) {
  const ecosystem::Ecosystem land = make_land({});
  const ecosystem::SuitabilityMap& map = land.layers[0].suitability;
  // A box that cuts cells, against many points in it.
  const base::Box box{land.extent.west + 33, land.extent.south + 41, land.extent.west + 177, land.extent.south + 222};
  PreviewOptions options = of_place();
  const Census census = take_census(land, options, box);
  for (std::size_t s = 0; s < 3; ++s) {
    double sum = 0;
    int count = 0;
    for (double x = box.west + 0.5; x < box.east; ++x) {
      for (double y = box.south + 0.5; y < box.north; ++y) {
        const int column = static_cast<int>((x - map.west) / map.cell_m);
        const int row = static_cast<int>((map.north - y) / map.cell_m);
        const std::uint8_t share = map.of(s)[row * map.columns + column];
        if (share == no_site) continue;
        sum += share / 254.0;
        ++count;
      }
    }
    ASSERT_GT(count, 1000);
    EXPECT_NEAR(census.layers[0][s].mean_suitability, sum / count, 1e-9);
  }
}

TEST(Heat, maps_that_are_not_there_tell_how_to_get_them) {
  MadeLand made;
  made.probabilities = false;
  const ecosystem::Ecosystem land = make_land(made);
  try {
    take_census(land, of_place(), land.extent);
    ADD_FAILURE() << "no error";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), ::testing::AllOf(HasSubstr("--layer"), HasSubstr("silvasim run ... --probabilities")));
  }
}

TEST(Heat, a_picture_has_the_ramps_colours_and_no_plants) {
  const testing::Folder folder;
  MadeLand made;
  made.terrain = false;
  ecosystem::Ecosystem land = make_land(made);
  fill(land, 0, 0, 254);
  fill(land, 0, 1, 0);
  PreviewOptions options = of_place({"Picea abies"});
  options.decorated = false;
  options.width_px = 300;
  write_png(land, options, folder / "best.png");
  const testing::Picture best = testing::read_png(folder / "best.png");
  for (const std::uint32_t colour : best.colours) ASSERT_EQ(colour, ramp(1));
  options.species = {"Fagus sylvatica"};
  write_png(land, options, folder / "none.png");
  const testing::Picture none = testing::read_png(folder / "none.png");
  for (const std::uint32_t colour : none.colours) ASSERT_EQ(colour, paper_colour);
}

TEST(Heat, title_and_caption_tell_of_whom) {
  const ecosystem::Ecosystem land = make_land({});
  const auto title = [&](std::vector<std::string> species) {
    const PreviewOptions options = of_place(std::move(species));
    return heat_title(land, take_census(land, options, land.extent), options);
  };
  EXPECT_EQ(title({"Picea abies"}), "suitability for Picea abies");
  EXPECT_EQ(title({"European beech"}), "suitability for European beech");
  EXPECT_EQ(title({"European beech", "Picea abies"}), "suitability for the best suited of 2 species");
  EXPECT_EQ(title({}), "suitability for the best suited of 3 species");
  EXPECT_THAT(heat_caption(land, take_census(land, of_place(), land.extent)),
              ::testing::AllOf(HasSubstr("the largest probability of 3 species"), HasSubstr("cells of 20 m")));
}

TEST(Heat, pictures_have_the_same_bytes_with_any_number_of_threads) {
  const testing::Folder folder;
  ecosystem::Ecosystem land = make_land({});
  testing::add_shrubs(land, {});
  for (const char* const name : {"f.png", "f.svg"}) {
    std::string first;
    for (const int threads : {1, 2, 3, 8}) {
      const base::ThreadLimit limit(threads);
      write_preview(land, of_place(), folder / name);
      if (first.empty()) first = testing::content(folder / name);
      EXPECT_TRUE(testing::content(folder / name) == first) << threads << " threads, " << name;
    }
  }
}

}  // namespace
}  // namespace silvasim::exports
