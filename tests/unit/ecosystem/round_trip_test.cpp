// read(write(e)) == e, for every e; the same bytes whatever the threads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "random_ecosystem.h"
#include "silvasim/base/error.h"
#include "silvasim/base/hash.h"
#include "silvasim/base/parallel.h"
#include "silvasim/ecosystem/file.h"
#include "silvasim/ecosystem/heights.h"
#include "surgery.h"

namespace silvasim::ecosystem {
namespace {

namespace fs = std::filesystem;

TEST(RoundTrip, GivesEveryEcosystemBack) {
  const std::uint64_t seed = 1;
  SCOPED_TRACE("seed " + std::to_string(seed));
  Random random(seed);
  for (int round = 0; round < 300; ++round) {
    const Ecosystem ecosystem = random_ecosystem(random);
    const auto bytes = to_bytes(ecosystem);
    const Ecosystem back = from_bytes(bytes, "test.silva");
    ASSERT_TRUE(back == ecosystem) << "round " << round;
    ASSERT_EQ(to_bytes(back), bytes) << "round " << round;
  }
}

TEST(RoundTrip, ThroughTheDiskIsTheSame) {
  const fs::path path = fs::temp_directory_path() / ("silva-round-trip-" + std::to_string(getpid()) + ".silva");
  Random random(2);
  for (int round = 0; round < 20; ++round) {
    const Ecosystem ecosystem = random_ecosystem(random);
    write(ecosystem, path);
    ASSERT_TRUE(read(path) == ecosystem);
    std::ifstream file(path, std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    const auto bytes = to_bytes(ecosystem);
    ASSERT_EQ(text, std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  }
  fs::remove(path);
}

// Many bands, of sites and of heights.
Ecosystem wide_ecosystem(std::size_t species) {
  Random random(3);
  Ecosystem ecosystem = small_ecosystem();
  ecosystem.terrain = random_terrain(random, 700, 900);
  ecosystem.layers = {random_layer(
      random, {.columns = 120, .rows = 130, .species = species, .most_sites = 100, .probabilities = true})};
  return ecosystem;
}

TEST(RoundTrip, SameBytesWithAnyNumberOfThreads) {
  const Ecosystem ecosystem = wide_ecosystem(9);
  ASSERT_GT(ecosystem.layers[0].plants.size(), 500'000u);
  std::vector<std::byte> one;
  {
    const base::ThreadLimit limit(1);
    one = to_bytes(ecosystem);
  }
  std::size_t bands = 0;
  for (const Part& part : take_apart(one).parts) bands += part.type == "PLNT" ? 1 : 0;
  EXPECT_GE(bands, 3u);
  for (const int threads : {2, 3, 8}) {
    const base::ThreadLimit limit(threads);
    EXPECT_EQ(to_bytes(ecosystem), one) << threads;
    EXPECT_TRUE(from_bytes(one, "test.silva") == ecosystem) << threads;
  }
}

TEST(RoundTrip, PlantIdsTakeTwoBytesFrom255Species) {
  for (const std::size_t species : {254u, 255u, 65534u}) {
    Random random(4);
    Ecosystem ecosystem = small_ecosystem();
    ecosystem.layers = {random_layer(random, {.columns = 5, .rows = 5, .species = species, .most_sites = 12})};
    Layer& layer = ecosystem.layers[0];
    for (PlantId& id : layer.plants) id = below(random, 3) ? static_cast<PlantId>(species - 1) : no_plant;
    const auto bytes = to_bytes(ecosystem);
    EXPECT_EQ(take_apart(bytes).part("PLNT").content.size(), layer.plants.size() * (species < 255 ? 1 : 2)) << species;
    EXPECT_TRUE(from_bytes(bytes, "test.silva") == ecosystem) << species;
  }
}

TEST(RoundTrip, EqualEcosystemsGiveEqualBytes) {
  Ecosystem ecosystem = small_ecosystem(), other = ecosystem;
  ecosystem.extent.west = 0.0;
  other.extent.west = -0.0;
  ecosystem.layers[0].tile_set.tiles[0].sites[0].x_m = 0.0f;
  other.layers[0].tile_set.tiles[0].sites[0].x_m = -0.0f;
  ASSERT_TRUE(ecosystem == other);
  EXPECT_EQ(to_bytes(ecosystem), to_bytes(other));
}

// A flat terrain of 20 million cells packs into almost nothing; the file must still be one that readers believe.
TEST(RoundTrip, LandThatIsAllAlikeIsBelieved) {
  Ecosystem ecosystem = small_ecosystem();
  ecosystem.terrain = {.columns = 5000, .rows = 4000, .heights_m = std::vector<float>(20'000'000, 12.5f)};
  const auto bytes = to_bytes(ecosystem);
  EXPECT_LT(bytes.size(), 100'000u);
  EXPECT_EQ(take_apart(bytes).part("FILL").flags, 1);
  EXPECT_TRUE(from_bytes(bytes, "test.silva") == ecosystem);
}

TEST(RoundTrip, TheSummaryTellsWhatTheFileHolds) {
  const fs::path path = fs::temp_directory_path() / ("silva-summary-" + std::to_string(getpid()) + ".silva");
  Random random(5);
  for (int round = 0; round < 30; ++round) {
    const Ecosystem ecosystem = random_ecosystem(random);
    write(ecosystem, path);
    const Summary summary = read_summary(path);
    EXPECT_EQ(summary.format_major, 1);
    EXPECT_EQ(summary.format_minor, 0);
    EXPECT_EQ(summary.file_bytes, fs::file_size(path));
    Ecosystem bare = ecosystem;
    bare.terrain.heights_m.clear();
    ASSERT_EQ(summary.plants.size(), bare.layers.size());
    for (std::size_t i = 0; i < bare.layers.size(); ++i) {
      Layer& layer = bare.layers[i];
      const auto standing =
          std::count_if(layer.plants.begin(), layer.plants.end(), [](PlantId id) { return id != no_plant; });
      EXPECT_EQ(summary.plants[i].sites, layer.plants.size());
      EXPECT_EQ(summary.plants[i].standing, static_cast<std::uint64_t>(standing));
      EXPECT_EQ(summary.plants[i].by_species, plants_by_species(layer));
      EXPECT_EQ(summary.plants[i].probabilities, !layer.probabilities.empty());
      layer.plants.clear();
      layer.probabilities.clear();
    }
    EXPECT_TRUE(summary.ecosystem == bare) << "round " << round;
  }
  fs::remove(path);
}

TEST(RoundTrip, StopsWhenTold) {
  const fs::path path = fs::temp_directory_path() / ("silva-stop-" + std::to_string(getpid()) + ".silva");
  const auto stop = [](std::string_view, double) { return false; };
  EXPECT_THROW(write(small_ecosystem(), path, {}, stop), base::Cancelled);
  EXPECT_FALSE(fs::exists(path));
  write(small_ecosystem(), path);
  EXPECT_THROW(read(path, stop), base::Cancelled);
  fs::remove(path);
}

TEST(Heights, ComeBackBitByBit) {
  Random random(6);
  for (int round = 0; round < 100; ++round) {
    const std::size_t columns = 1 + below(random, 40), rows = 1 + below(random, 40);
    std::vector<float> heights(columns * rows);
    // Every bit pattern, signalling NaN and infinities among them.
    for (float& height : heights) {
      const auto bits = static_cast<std::uint32_t>(round % 2 ? random() : 0x43000000 + below(random, 1000));
      std::memcpy(&height, &bits, sizeof bits);
    }
    std::vector<float> back(heights.size());
    heights_from_bytes(bytes_from_heights(heights, columns), columns, back);
    ASSERT_EQ(std::memcmp(heights.data(), back.data(), heights.size() * sizeof(float)), 0) << "round " << round;
  }
}

// What no reader would take, no writer writes.
TEST(Validity, WhatMakesNoSenseIsNotWritten) {
  using testing::HasSubstr;
  const auto expect = [](const std::string& what, auto spoil) {
    Ecosystem ecosystem = small_ecosystem();
    spoil(ecosystem, ecosystem.layers[0]);
    EXPECT_THAT([&] { to_bytes(ecosystem); }, testing::ThrowsMessage<base::Error>(HasSubstr(what))) << what;
  };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  using E = Ecosystem;
  using L = Layer;
  expect("name is not UTF-8", [](E& e, L&) { e.name = "\xff"; });
  expect("name is not UTF-8", [](E& e, L&) { e.name = std::string(1, '\0'); });
  expect("CRS is not UTF-8", [](E& e, L&) { e.crs_wkt = "\xc3"; });
  expect("extent is empty", [](E& e, L&) { e.extent = {}; });
  expect("extent is empty", [](E& e, L&) { e.extent.east = nan; });
  expect("not one JSON object", [](E& e, L&) { e.provenance_json = ""; });
  expect("not one JSON object", [](E& e, L&) { e.provenance_json = "[]"; });
  expect("not one JSON object", [](E& e, L&) { e.provenance_json = "{}{}"; });
  expect("not one JSON object", [](E& e, L&) { e.provenance_json = "{\"a\": \"\xff\"}"; });
  expect("terrain of 0 x 2", [](E& e, L&) { e.terrain.columns = 0; });
  expect("terrain of -3 x -2", [](E& e, L&) { e.terrain.columns = -3, e.terrain.rows = -2; });
  expect("6 heights for 12 cells", [](E& e, L&) { e.terrain.columns = 6; });
  expect("cells larger than 0", [](E& e, L&) { e.terrain.cell_width_m = 0; });
  expect("height number 4 is infinite", [](E& e, L&) { e.terrain.heights_m[4] = -static_cast<float>(infinity); });
  expect("no vegetation layer", [](E& e, L&) { e.layers.clear(); });
  expect("two layers are named \"trees\"", [](E& e, L& l) { e.layers.push_back(L(l)); });
  expect("corner of layer \"trees\" is not finite", [](E&, L& l) { l.north_west.x = nan; });
  expect("two species are named", [](E&, L& l) { l.species[1].name = l.species[0].name; });
  expect("species number 1 has a colour", [](E&, L& l) { l.species[1].colour = 1 << 24; });
  expect("species number 0 needs", [](E&, L& l) { l.species[0].model_radius_m = 0; });
  expect("reversed scale range", [](E&, L& l) { l.species[0].least_scale = l.species[0].most_scale + 1; });
  expect("65534 species at most", [](E&, L& l) { l.species.resize(65535); });
  expect("side and largest radius", [](E&, L& l) { l.tile_set.side_m = infinity; });
  expect("colours and", [](E&, L& l) { l.tile_set.variants = 0; });
  expect("colours x colours x variants", [](E&, L& l) { l.tile_set.tiles.pop_back(); });
  expect("tile 0 has an edge", [](E&, L& l) { l.tile_set.tiles[0].colours.east = 200; });
  expect("out of order", [](E&, L& l) {
    l.tile_set.colours = 2, l.tile_set.variants = 1;
    l.tile_set.tiles.assign(4, {});
  });
  expect("tile 0: site 0 lies at",
         [](E&, L& l) { l.tile_set.tiles[0].sites[0].x_m = static_cast<float>(l.tile_set.side_m) + 1; });
  expect("tile 0: site 0 lies at", [](E&, L& l) { l.tile_set.tiles[0].sites[0].y_m = -1; });
  expect("tile 0: site 0 lies at", [](E&, L& l) { l.tile_set.tiles[0].sites[0].y_m = static_cast<float>(nan); });
  expect("tile 0: site 0 has the radius", [](E&, L& l) { l.tile_set.tiles[0].sites[0].radius_m = 0; });
  expect("tile 0: site 0 has the radius", [](E&, L& l) { l.tile_set.tiles[0].sites[0].radius_m = 1e9f; });
  expect("tiling of 0 x", [](E&, L& l) { l.tiling.columns = 0; });
  expect("the tiling holds", [](E&, L& l) { l.tiling.tiles.pop_back(); });
  expect("column 1, row 0 of the tiling holds tile 999", [](E&, L& l) { l.tiling.tiles[1] = 999; });
  expect("plant ids for", [](E&, L& l) { l.plants.pop_back(); });
  expect("probabilities for", [](E&, L& l) { l.probabilities.pop_back(); });
  expect("shares for", [](E&, L& l) { l.suitability.shares.pop_back(); });
  expect("suitability map", [](E&, L& l) { l.suitability.cell_m = 0; });
  expect("suitability map", [](E&, L& l) { l.suitability.west = NAN; });
  expect("site number 1 holds species 2 of 2", [](E&, L& l) { l.plants[1] = 2; });
  const auto ill_fitting = [](int columns, int rows, std::vector<std::uint16_t> tiles) {
    return [=](E&, L& l) {
      l.tile_set.colours = 2;
      l.tile_set.variants = 1;
      l.tile_set.tiles = {{{0, 0, 0, 0}, {}}, {{0, 0, 0, 1}, {}}, {{1, 0, 0, 0}, {}}, {{1, 0, 0, 1}, {}}};
      l.tiling = {columns, rows, tiles};
      l.plants.clear();
      l.probabilities.clear();
    };
  };
  expect("column 1, row 0 of the tiling does not fit its western", ill_fitting(2, 1, {0, 1}));
  expect("column 0, row 1 of the tiling does not fit its northern", ill_fitting(1, 2, {0, 2}));
  expect("column 1, row 1 of the tiling does not fit its northern", ill_fitting(2, 2, {0, 0, 0, 2}));
}

}  // namespace
}  // namespace silvasim::ecosystem
