// What the ground looks like, and what stands over it, against plain sums over all plants.
#include "silvavis/shade/land.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "silvasim/base/random.h"
#include "silvavis/shade/patches.h"

namespace silvavis::shade {
namespace {

using silvasim::base::Stream;

struct Plant {
  double x, y, radius;
};

// Tiles of 40 m, three by three, each with the same plants, of which every third place is empty.
scene::Scene wood(std::vector<Plant>& all) {
  silvasim::ecosystem::Ecosystem e;
  e.extent = {0, 0, 120, 120};
  silvasim::ecosystem::Layer layer;
  layer.name = "trees";
  layer.tile_set.side_m = 40;
  layer.tile_set.most_radius_m = 4;
  layer.tile_set.colours = layer.tile_set.variants = 1;
  layer.tile_set.tiles.emplace_back();
  Stream stream(11, silvasim::base::Purpose::selection);
  for (int i = 0; i < 60; ++i)
    layer.tile_set.tiles[0].sites.push_back(
        {40 * stream.next_float(), 40 * stream.next_float(), 1 + 3 * stream.next_float()});
  layer.tiling = {3, 3, std::vector<std::uint16_t>(9, 0)};
  layer.north_west = {0, 120};
  silvasim::ecosystem::Species species;
  species.name = "one";
  layer.species.push_back(species);
  layer.plants.assign(9 * 60, 0);
  for (std::size_t i = 0; i < layer.plants.size(); i += 3) layer.plants[i] = silvasim::ecosystem::no_plant;
  for (std::size_t position = 0; position < 9; ++position) {
    for (std::size_t site = 0; site < 60; ++site) {
      if (layer.plants[position * 60 + site] == silvasim::ecosystem::no_plant) continue;
      const auto& s = layer.tile_set.tiles[0].sites[site];
      all.push_back({static_cast<double>(position % 3) * 40 + static_cast<double>(s.x_m) - 60,
                     (2 - static_cast<double>(position / 3)) * 40 + static_cast<double>(s.y_m) - 60,
                     static_cast<double>(s.radius_m)});
    }
  }
  e.layers.push_back(std::move(layer));
  auto model = std::make_shared<scene::PlantModel>();
  model->reach_m = 1;
  model->most = {1, 1, 10};
  return scene::make_scene(std::move(e), {{{model}}});
}

TEST(Crowns, AreThoseOfAllPlants) {
  std::vector<Plant> plants;
  const scene::Scene scene = wood(plants);
  ASSERT_EQ(scene.plants, plants.size());
  Stream stream(12, silvasim::base::Purpose::selection);
  int covered = 0;
  for (int i = 0; i < 4000; ++i) {
    const double x = 130 * stream.next_double() - 65, y = 130 * stream.next_double() - 65;
    double cover = 0, foot = 0, near = 0;
    for (const Plant& plant : plants) {
      const double d = std::hypot(x - plant.x, y - plant.y), away = d / plant.radius;
      cover = std::max(cover, std::clamp((1.25 - away) * 1.6, 0.0, 1.0));
      foot = std::max(foot, 1 - 5 * away);
      near = std::max(near, std::clamp(1 - (d - plant.radius) / 5, 0.0, 1.0));
    }
    const Crowns got = crowns_over(scene, x, y);
    EXPECT_NEAR(static_cast<double>(got.cover), cover, 2e-3) << x << " " << y;
    EXPECT_NEAR(static_cast<double>(got.foot), foot, 5e-3) << x << " " << y;
    EXPECT_NEAR(static_cast<double>(got.near), near, 2e-3) << x << " " << y;
    covered += cover > 0;
  }
  EXPECT_GT(covered, 1000);
}

// Mean over a square kilometre.
Rgb mean_colour(const V3& up, double height_m, const Crowns& crowns = {}, const Land& land = {}) {
  Rgb sum(0, 0, 0);
  Stream stream(3, silvasim::base::Purpose::selection);
  constexpr int count = 20000;
  for (int i = 0; i < count; ++i)
    sum += land_colour(land, 2000 * stream.next_double(), 2000 * stream.next_double(), up, height_m, crowns);
  return sum / count;
}

TEST(Land, IsGreenWhereGentleGreyWhereSteepBrownUnderTrees) {
  const V3 level(0, 0, 1), steep = V3(0.8f, 0, 0.6f).normalized();
  const Rgb meadow = mean_colour(level, 300), cliff = mean_colour(steep, 300), high = mean_colour(level, 2900);
  const Rgb wood = mean_colour(level, 300, {1, 0, 1});
  // Measured: grass reflects 0.06 to 0.12 of green light and less of red (Clark et al. 2007); rock is grey; litter red before green.
  EXPECT_GT(meadow.y, 1.05f * meadow.x);
  EXPECT_GT(meadow.x, 1.5f * meadow.z);
  EXPECT_GT(meadow.y, 0.05f);
  EXPECT_LT(meadow.y, 0.12f);
  EXPECT_NEAR(cliff.x / cliff.y, 1, 0.1f);
  EXPECT_LT(cliff.x / cliff.z, 1.4f);
  EXPECT_LT(high.y, 1.05f * high.x);
  EXPECT_GT(wood.x, wood.y);
  EXPECT_LT(luminance(wood), 0.75f * luminance(meadow));
  // A sunny slope is drier than a shady one.
  EXPECT_GT(mean_colour(V3(0, -0.3f, 0.95f), 300).x, 1.05f * mean_colour(V3(0, 0.3f, 0.95f), 300).x);
  // Rocks are not bare within a wood.
  EXPECT_LT(luminance(mean_colour(steep, 300, {0, 0, 1})), 0.8f * luminance(cliff));
}

TEST(Land, IsUnevenAtAllSizes) {
  const V3 level(0, 0, 1);
  for (const double apart : {0.1, 2.0, 20.0, 150.0}) {
    double sum = 0;
    Stream stream(8, silvasim::base::Purpose::selection);
    for (int i = 0; i < 2000; ++i) {
      const double x = 3000 * stream.next_double(), y = 3000 * stream.next_double();
      sum += std::abs(std::log(static_cast<double>(luminance(land_colour({}, x, y, level)) /
                                                   luminance(land_colour({}, x + apart, y, level)))));
    }
    EXPECT_GT(sum / 2000, 0.06) << apart;
    EXPECT_LT(sum / 2000, 0.6) << apart;
  }
}

TEST(Land, ClassesKeepTheirMeanColour) {
  Land land;
  land.drape = image::Image(1, 1, 3);
  const Rgb colour(0.2f, 0.1f, 0.3f);
  std::copy_n(&colour.x, 3, land.drape.at(0, 0));
  land.drape_box = {-1, -1, 2001, 2001};
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(land_colour(land, 7, 9, V3(0, 0, 1))[c], colour[c], 1e-6f);  // a picture as it is
  land.smooth = false;
  const Rgb mean = mean_colour(V3(0, 0, 1), 0, {}, land);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], colour[c], 0.05f * colour[c]);
  EXPECT_NE(land_colour(land, 7, 9, V3(0, 0, 1)), land_colour(land, 8, 9, V3(0, 0, 1)));
}

TEST(Patches, AreSmoothAndFillTheirRange) {
  double sum = 0, least = 1, most = 0;
  Stream stream(2, silvasim::base::Purpose::selection);
  for (int i = 0; i < 20000; ++i) {
    const double x = 2e5 * (stream.next_double() - 0.5), y = 2e5 * (stream.next_double() - 0.5);
    const auto p = static_cast<double>(patches(x, y, 10));
    sum += p;
    least = std::min(least, p);
    most = std::max(most, p);
    EXPECT_NEAR(p, static_cast<double>(patches(x + 0.01, y, 10)), 0.01);
  }
  EXPECT_NEAR(sum / 20000, 0.5, 0.01);
  EXPECT_GE(least, 0);
  EXPECT_LE(most, 1);
  EXPECT_LT(least, 0.15);
  EXPECT_GT(most, 0.85);
}

}  // namespace
}  // namespace silvavis::shade
