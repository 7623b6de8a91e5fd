// A reader written in Python from docs/ecosystem-file.md alone reads the same as ours.
#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "random_ecosystem.h"
#include "silvasim/ecosystem/file.h"

namespace silvasim::ecosystem {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::uint64_t bits(double number) { return std::bit_cast<std::uint64_t>(number); }
std::uint32_t bits(float number) { return std::bit_cast<std::uint32_t>(number); }

json told(const Ecosystem& ecosystem) {
  json all;
  const base::Box& box = ecosystem.extent;
  const Terrain& terrain = ecosystem.terrain;
  all["layer_count"] = ecosystem.layers.size();
  all["extent"] = {bits(box.west), bits(box.south), bits(box.east), bits(box.north)};
  all["name"] = ecosystem.name;
  all["crs_wkt"] = ecosystem.crs_wkt;
  all["provenance"] = ecosystem.provenance_json;
  all["grid"] = {terrain.columns,
                 terrain.rows,
                 bits(terrain.west),
                 bits(terrain.north),
                 bits(terrain.cell_width_m),
                 bits(terrain.cell_height_m)};
  all["heights"] = json::array();
  for (const float height : terrain.heights_m) all["heights"].push_back(bits(height));
  for (const Layer& layer : ecosystem.layers) {
    json one;
    one["name"] = layer.name;
    one["north_west"] = {bits(layer.north_west.x), bits(layer.north_west.y)};
    one["size"] = {layer.tiling.columns, layer.tiling.rows};
    one["sites"] = layer.plants.size();
    one["probable"] = layer.probabilities.empty() ? 0 : 1;
    one["species"] = one["tiles"] = one["plants"] = json::array();
    const auto counts = plants_by_species(layer);
    for (std::size_t i = 0; i < layer.species.size(); ++i) {
      const Species& s = layer.species[i];
      one["species"].push_back({s.name, s.common_name, s.model, s.colour, bits(s.model_radius_m), bits(s.height_m),
                                bits(s.least_scale), bits(s.most_scale), counts[i]});
    }
    const tiles::TileSet& set = layer.tile_set;
    one["tile_set"] = {bits(set.side_m), bits(set.most_radius_m), set.colours, set.variants};
    for (const tiles::Tile& tile : set.tiles) {
      json sites = json::array();
      for (const tiles::Site& site : tile.sites) sites.push_back({bits(site.x_m), bits(site.y_m), bits(site.radius_m)});
      const tiles::EdgeColours& edge = tile.colours;
      one["tiles"].push_back({{edge.north, edge.east, edge.south, edge.west}, sites});
    }
    one["tiling"] = layer.tiling.tiles;
    for (const PlantId id : layer.plants) one["plants"].push_back(id == no_plant ? -1 : id);
    one["probabilities"] = layer.probabilities;
    if (const SuitabilityMap& map = layer.suitability; !map.empty()) {
      one["map"] = {map.columns, map.rows, bits(map.west), bits(map.north), bits(map.cell_m), map.shares};
    }
    all["layers"].push_back(one);
  }
  return all;
}

TEST(Stranger, ReadsTheSame) {
  if (std::system("python3 -c 'import ctypes; ctypes.CDLL(\"libzstd.so.1\"); ctypes.CDLL(\"libxxhash.so.0\")' 2>&1") !=
      0) {
    GTEST_SKIP() << "needs python3 and the shared libraries of zstd and xxHash";
  }
  const fs::path path = fs::temp_directory_path() / ("silva-stranger-" + std::to_string(getpid()) + ".silva");
  const std::string script = SILVA_SOURCE_DIR "/tests/unit/ecosystem/stranger.py";
  Random random(12);
  for (int round = 0; round < 6; ++round) {
    // The last one has bands: several of sites, several of heights.
    Ecosystem ecosystem = random_ecosystem(random);
    if (round == 5) {
      ecosystem.terrain = random_terrain(random, 500, 600);
      ecosystem.layers = {random_layer(random, {.columns = 60, .rows = 60, .species = 9, .most_sites = 200})};
    }
    write(ecosystem, path);
    std::string text;
    FILE* pipe = popen(("python3 " + script + " " + path.string()).c_str(), "r");
    ASSERT_NE(pipe, nullptr);
    char buffer[1 << 16];
    for (std::size_t got; (got = fread(buffer, 1, sizeof buffer, pipe)) > 0;) text.append(buffer, got);
    ASSERT_EQ(pclose(pipe), 0) << "round " << round;
    const json theirs = json::parse(text), ours = told(ecosystem);
    for (const auto& [key, value] : ours.items()) {
      if (key == "layers") continue;  // long: their difference would not be readable
      EXPECT_EQ(theirs.at(key), value) << key << ", round " << round;
    }
    EXPECT_TRUE(theirs.at("layers") == ours.at("layers")) << "round " << round;
    EXPECT_EQ(theirs.size(), ours.size());
  }
  fs::remove(path);
}

}  // namespace
}  // namespace silvasim::ecosystem
