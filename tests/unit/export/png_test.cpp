#include <gdal_frmts.h>
#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <memory>

#include "files.h"
#include "made_land.h"
#include "silvasim/base/error.h"
#include "silvasim/base/parallel.h"
#include "silvasim/export/cover.h"
#include "silvasim/export/picture.h"

namespace silvasim::exports {
namespace {

using testing::content;
using testing::Folder;
using testing::MadeLand;
using testing::make_land;
using testing::Picture;
using testing::read_png;
using testing::read_world;
using testing::World;

template <typename Visit>
void for_each(const ecosystem::Ecosystem& land, std::size_t layer, Visit&& visit) {
  const ecosystem::Layer& of = land.layers[layer];
  ecosystem::for_each_plant(of, ecosystem::site_offsets(of.tile_set, of.tiling), 0, of.tiling.rows, visit);
}

MadeLand few_plants() {
  MadeLand made;
  made.columns = 3;
  made.rows = 2;
  return made;
}

TEST(Png, a_plants_pixel_has_its_species_colour_where_the_world_file_says) {
  const Folder folder;
  const ecosystem::Ecosystem land = make_land(few_plants());
  for (const bool decorated : {true, false}) {
    for (const bool cut : {false, true}) {
      PreviewOptions options;
      options.decorated = decorated;
      if (cut) options.bbox = base::Box{600033.3, 5190021.7, 600244.4, 5190190.1};
      write_png(land, options, folder / "f.png");
      const Picture picture = read_png(folder / "f.png");
      const World world = read_world(folder / "f.pgw");
      EXPECT_EQ(picture.width, options.width_px);
      const base::Box box = options.bbox.value_or(land.extent);
      int seen = 0;
      for_each(land, 0, [&](const ecosystem::Plant& plant) {
        // Half a radius from the stem: inside the crown, off the stem's dot and off the outline.
        const double radius = static_cast<double>(plant.radius_m);
        const base::Point spot{plant.at.x, plant.at.y + radius / 2};
        if (radius / world.east < 6 || !base::grown(box, -2 * world.east).contains(spot)) return;
        const int x = static_cast<int>(std::lround(world.pixel_x(spot.x))),
                  y = static_cast<int>(std::lround(world.pixel_y(spot.y)));
        ASSERT_TRUE(x >= 0 && x < picture.width && y >= 0 && y < picture.height);
        EXPECT_EQ(picture.at(x, y), land.layers[0].species[plant.species].colour) << x << " " << y;
        ++seen;
      });
      EXPECT_GT(seen, 100);
    }
  }
}

TEST(Png, the_bare_map_is_the_land_and_nothing_else) {
  const Folder folder;
  const ecosystem::Ecosystem land = make_land(few_plants());
  PreviewOptions options;
  options.decorated = false;
  options.width_px = 300;
  write_png(land, options, folder / "f.png");
  const Picture picture = read_png(folder / "f.png");
  EXPECT_EQ(picture.width, 300);
  EXPECT_EQ(picture.height, 200);
  const World world = read_world(folder / "f.pgw");
  EXPECT_DOUBLE_EQ(world.east, land.extent.width() / 300);
  EXPECT_DOUBLE_EQ(world.south, -land.extent.height() / 200);
  EXPECT_DOUBLE_EQ(world.x, land.extent.west + world.east / 2);
  EXPECT_DOUBLE_EQ(world.y, land.extent.north + world.south / 2);
}

TEST(Png, brings_the_crs_for_gdal_where_it_is_known) {
  const Folder folder;
  MadeLand made = few_plants();
  write_png(make_land(made), {}, folder / "local.png");
  made.crs_wkt = testing::utm_10_north();
  write_png(make_land(made), {}, folder / "utm.png");
  EXPECT_THAT(folder.names(), ::testing::ElementsAre("local.pgw", "local.png", "local.png.aux.xml", "utm.pgw",
                                                     "utm.png", "utm.png.aux.xml"));
  // Read as a GIS reads it: by the format's name alone.
  GDALRegister_PNG();
  const std::unique_ptr<GDALDataset> picture(GDALDataset::Open((folder / "utm.png").c_str(), GDAL_OF_RASTER));
  ASSERT_TRUE(picture && picture->GetSpatialRef());
  EXPECT_STREQ(picture->GetSpatialRef()->GetAuthorityCode(nullptr), "32610");
  const std::unique_ptr<GDALDataset> local(GDALDataset::Open((folder / "local.png").c_str(), GDAL_OF_RASTER));
  EXPECT_EQ(local->GetSpatialRef(), nullptr);
}

TEST(Png, has_the_same_bytes_with_any_number_of_threads) {
  const Folder folder;
  MadeLand made;
  made.columns = 20;
  made.rows = 20;
  ecosystem::Ecosystem land = make_land(made);
  add_shrubs(land, made);
  for (const Subject subject : {Subject::species, Subject::probability}) {
    for (const int width : {300, 1000}) {
      PreviewOptions options;
      options.width_px = width;
      options.subject = subject;
      std::string first;
      for (const int threads : {1, 2, 3, 8}) {
        const base::ThreadLimit limit(threads);
        write_png(land, options, folder / "f.png");
        if (first.empty()) first = content(folder / "f.png");
        EXPECT_TRUE(content(folder / "f.png") == first) << threads << " threads, " << width << " pixels";
      }
    }
  }
}

// The share of crowns that pixels of one species over paper show, from their colours alone.
TEST(Png, a_species_map_covers_as_much_as_the_crowns_do) {
  const Folder folder;
  // Crowns far smaller than a pixel, then about as wide as one.
  for (const auto& [columns, side, width] : {std::tuple{60, 100.0, 200}, {20, 100.0, 700}}) {
    MadeLand made;
    made.columns = columns;
    made.rows = columns;
    made.side_m = side;
    made.species = 1;
    made.terrain = false;
    made.stands = 0.5;
    ecosystem::Ecosystem land = make_land(made);
    PreviewOptions options;
    options.width_px = width;
    options.decorated = false;
    write_png(land, options, folder / "f.png");
    const Picture picture = read_png(folder / "f.png");

    const Census census = take_census(land, options, land.extent);
    const View view{land.extent, picture.width, picture.height};
    ASSERT_EQ(style_of(census, view), Style::cover);
    const int boldness = boldness_of(census.mean_radius_m * view.px_per_m(), Subject::species);
    const auto light = [](std::uint32_t colour, int shift) {
      const double value = ((colour >> shift) & 0xFF) / 255.0;
      return value * value;
    };
    const std::uint32_t full = land.layers[0].species[0].colour;
    double covered = 0, area = 0;
    for (const std::uint32_t colour : picture.colours) {
      // Red has the widest span between paper and this green.
      const double share = (light(paper_colour, 16) - light(colour, 16)) / (light(paper_colour, 16) - light(full, 16));
      // The other channels agree: the pixel is a mix of paper and species, nothing else.
      for (const int shift : {8, 0}) {
        const double wanted = light(paper_colour, shift) + (light(full, shift) - light(paper_colour, shift)) * share;
        ASSERT_NEAR(light(colour, shift), wanted, 0.015);
      }
      covered += 1 - std::pow(std::max(0.0, 1 - share), 1.0 / boldness);
    }
    for_each(land, 0, [&](const ecosystem::Plant& plant) {
      area += 3.14159265358979 * static_cast<double>(plant.radius_m) * static_cast<double>(plant.radius_m);
    });
    const double wanted = area / (land.extent.width() * land.extent.height());
    EXPECT_NEAR(covered / static_cast<double>(picture.colours.size()), wanted, 0.02 * wanted) << width;
    EXPECT_GT(wanted, 0.1);
  }
}

TEST(Png, probability_one_is_the_ramps_end) {
  const Folder folder;
  ecosystem::Ecosystem land = make_land(few_plants());
  std::fill(land.layers[0].probabilities.begin(), land.layers[0].probabilities.end(), std::uint16_t{65535});
  PreviewOptions options;
  options.subject = Subject::probability;
  options.species = {"European larch"};
  write_png(land, options, folder / "f.png");
  const Picture picture = read_png(folder / "f.png");
  const World world = read_world(folder / "f.pgw");
  int others = 0, shown = 0;
  for_each(land, 0, [&](const ecosystem::Plant& plant) {
    const double radius = static_cast<double>(plant.radius_m);
    if (radius / world.east < 6) return;
    const std::uint32_t colour = picture.at(static_cast<int>(std::lround(world.pixel_x(plant.at.x))),
                                            static_cast<int>(std::lround(world.pixel_y(plant.at.y + radius / 2))));
    (plant.species == 2 ? shown : others) += 1;
    EXPECT_EQ(colour == ramp(1), plant.species == 2);
  });
  EXPECT_GT(shown, 20);
  EXPECT_GT(others, 20);
}

TEST(Png, later_layers_lie_over_earlier_ones) {
  const Folder folder;
  MadeLand made = few_plants();
  ecosystem::Ecosystem land = make_land(made);
  // One shrub right on one tree.
  ecosystem::Layer shrubs = land.layers[0];
  shrubs.name = "shrubs";
  shrubs.species = {{"Corylus avellana", "Hazel", 0x123456, "", 1, 1, 0, 9}};
  for (tiles::Tile& tile : shrubs.tile_set.tiles) {
    for (tiles::Site& site : tile.sites) site.radius_m *= 0.5f;
  }
  for (ecosystem::PlantId& plant : shrubs.plants) plant = plant == ecosystem::no_plant ? plant : 0;
  land.layers.push_back(shrubs);
  write_png(land, {}, folder / "f.png");
  const Picture picture = read_png(folder / "f.png");
  const World world = read_world(folder / "f.pgw");
  for_each(land, 0, [&](const ecosystem::Plant& plant) {
    const double radius = static_cast<double>(plant.radius_m);
    if (radius / world.east < 12) return;
    const int x = static_cast<int>(std::lround(world.pixel_x(plant.at.x)));
    EXPECT_EQ(picture.at(x, static_cast<int>(std::lround(world.pixel_y(plant.at.y + 0.25 * radius)))), 0x123456u);
    EXPECT_EQ(picture.at(x, static_cast<int>(std::lround(world.pixel_y(plant.at.y + 0.7 * radius)))),
              land.layers[0].species[plant.species].colour);
  });
}

TEST(Png, lands_at_the_edge_of_sense_are_drawn) {
  const Folder folder;
  const auto expect_picture = [&](const ecosystem::Ecosystem& land, const char* what, PreviewOptions options = {}) {
    std::filesystem::remove(folder / "f.png");
    EXPECT_NO_THROW(write_png(land, options, folder / "f.png")) << what;
    EXPECT_GT(read_png(folder / "f.png").width, 0) << what;
    EXPECT_NO_THROW(write_svg(land, options, folder / "f.svg")) << what;
  };
  ecosystem::Ecosystem land = make_land(few_plants());
  ecosystem::Ecosystem bare = land;
  std::fill(bare.layers[0].plants.begin(), bare.layers[0].plants.end(), ecosystem::no_plant);
  expect_picture(bare, "no plants");
  bare.layers[0].plants[7] = 1;
  expect_picture(bare, "one plant");
  bare.layers[0].species.clear();
  bare.layers[0].plants[7] = ecosystem::no_plant;
  expect_picture(bare, "no species");
  bare.layers[0].tile_set.tiles.assign(18, {});
  bare.layers[0].plants.clear();
  bare.layers[0].probabilities.clear();
  expect_picture(bare, "no sites");

  ecosystem::Ecosystem flat = land;
  flat.terrain = {};
  expect_picture(flat, "flat");
  flat = land;
  std::fill(flat.terrain.heights_m.begin(), flat.terrain.heights_m.end(), std::numeric_limits<float>::quiet_NaN());
  expect_picture(flat, "no data anywhere");

  PreviewOptions tiny;
  tiny.bbox = base::Box{600100, 5190100, 600100.001, 5190100.001};
  expect_picture(land, "a millimetre", tiny);
  PreviewOptions huge;
  huge.bbox = base::grown(land.extent, 4e6);
  expect_picture(land, "eight thousand kilometres", huge);
  for (const int width : {240, 640, 2500}) {
    PreviewOptions options;
    options.width_px = width;
    expect_picture(land, "width", options);
  }
}

TEST(Png, what_cannot_be_written_leaves_nothing) {
  const Folder folder;
  const ecosystem::Ecosystem land = make_land(few_plants());
  EXPECT_THROW(write_png(land, {}, folder / "missing/f.png"), base::Error);
  PreviewOptions options;
  options.species = {"nothing"};
  EXPECT_THROW(write_png(land, options, folder / "f.png"), base::ConfigError);
  // The world file's name is taken by a folder.
  std::filesystem::create_directory(folder / "g.pgw");
  EXPECT_THROW(write_png(land, {}, folder / "g.png"), base::Error);
  EXPECT_THROW(write_preview(land, {}, folder / "f.gif"), base::ConfigError);
  EXPECT_THAT(folder.names(), ::testing::ElementsAre("g.pgw"));
}

}  // namespace
}  // namespace silvasim::exports
