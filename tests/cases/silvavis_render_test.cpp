// silvavis render and info: cameras by name, what the numbers in an EXR mean, how the land looks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "silvasim/ecosystem/file.h"
#include "silvavis/image/file.h"
#include "silvavis/shade/camera.h"
#include "tests/cases/silvavis_program.h"

namespace silvasim::cases {
namespace {

using silvavis::V3d;
using ::testing::HasSubstr;

struct View {
  V3d eye, look_at;

  static std::string text(const V3d& p) {
    return std::to_string(p.x) + "," + std::to_string(p.y) + "," + std::to_string(p.z);
  }
};

// From the south-west of an example's middle, downwards.
View over(const std::string& example) {
  const auto e = ecosystem::read(grown(example));
  const V3d middle(std::round((e.extent.west + e.extent.east) / 2), std::round((e.extent.south + e.extent.north) / 2),
                   0);
  const double ground = std::round(ecosystem::height_at(e.terrain, {middle.x, middle.y}));
  return {middle + V3d(-60, -90, ground + 70), middle + V3d(0, 0, ground)};
}

TEST(Cameras, ByNameAndByNumbersAreTheSame) {
  const Folder folder;
  const std::string forest = grown("02-elevation");
  const View view = over("02-elevation");
  const auto attributes = [](const V3d& p, const std::string& above) {
    return " x=\"" + std::to_string(p.x) + "\" y=\"" + std::to_string(p.y) + "\" height=\"" + std::to_string(p.z) +
           "\"" + above + "/>\n";
  };
  write(folder / "c.xml", "<cameras><camera name=\"hill\" fov=\"40 deg\">\n<eye" + attributes(view.eye, "") +
                              "<look-at" + attributes({view.look_at.x, view.look_at.y, 3}, " above=\"ground\"") +
                              "</camera>\n" + "<camera name=\"other\"><eye x=\"1\" y=\"2\" height=\"3\"/>" +
                              "<look-at x=\"4\" y=\"2\" height=\"3\"/></camera></cameras>");
  ASSERT_EQ(quick({"render", forest, "--camera", folder / "c.xml#hill", "--spp", "1", "-o", folder / "a.exr"}).code, 0);
  const std::string at = std::to_string(view.look_at.x) + "," + std::to_string(view.look_at.y) + ",+3";
  ASSERT_EQ(quick({"render", forest, "--eye", View::text(view.eye), "--look-at", at, "--fov", "40", "--spp", "1", "-o",
                   folder / "b.exr"})
                .code,
            0);
  EXPECT_EQ(read(folder / "a.exr"), read(folder / "b.exr"));

  const auto error = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render", forest, "-o", folder / "x.png"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = quick(arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "x.png"));
    return outcome.err;
  };
  EXPECT_THAT(error({"--camera", folder / "c.xml#hil"}), HasSubstr("no camera \"hil\"; did you mean \"hill\"?"));
  EXPECT_THAT(error({"--camera", folder / "c.xml"}), HasSubstr("several cameras"));
  error({"--camera", folder / "c.xml#hill", "--fov", "30"});
  error({"--camera", folder / "c.xml#hill", "--eye", "1,2,3", "--look-at", "1,2,4"});
  write(folder / "d.xml",
        "<cameras>\n  <camera name=\"a\"><eye x=\"1\" y=\"2\" hight=\"3\"/><look-at x=\"1\" y=\"2\" "
        "height=\"inf\"/></camera></cameras>");
  EXPECT_THAT(error({"--camera", folder / "d.xml#a"}),
              testing::AllOf(HasSubstr("d.xml:2:37: error: <eye> has no attribute \"hight\"; did you mean \"height\"?"),
                             HasSubstr("is no finite number")));
}

// Wrong cameras are named before anyone waits for models, by the ground as it is: one that looks straight down on high land is
// right, though over land at height 0 it would look at itself.
TEST(Cameras, AreJudgedBeforeModelsAreMade) {
  const Folder folder;
  const std::string forest = grown("02-elevation");
  const View view = over("02-elevation");
  const auto camera = [&](const std::string& height) {
    const std::string place =
        " x=\"" + std::to_string(view.look_at.x) + "\" y=\"" + std::to_string(view.look_at.y) + "\" ";
    write(folder / "c.xml", "<cameras><camera name=\"down\"><eye" + place +
                                "height=\"300\" above=\"ground\"/><look-at" + place + "height=\"" + height +
                                "\"/></camera></cameras>");
    return silvavis({"render", forest, "--camera", folder / "c.xml#down", "-o", folder / "a.png", "--size", "16x9",
                     "--spp", "1", "--triangles", "1000"});
  };
  ASSERT_GT(view.look_at.z, 50);
  const Outcome down = camera("300");
  EXPECT_EQ(down.code, 0) << down.err;
  EXPECT_THAT(down.err, HasSubstr("models ..."));
  const auto refused = [&](const Outcome& outcome, const char* what, int code = 2) {
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_THAT(outcome.err, testing::AllOf(HasSubstr("read ..."), HasSubstr(what), testing::Not(HasSubstr("models"))));
  };
  refused(camera("300\" above=\"ground"), "the eye is where it looks at");
  refused(silvavis({"render", forest, "--camera", folder / "c.xml#up", "-o", folder / "b.png"}), "no camera \"up\"");
  refused(silvavis({"render", forest, "--camera", folder / "none.xml", "-o", folder / "b.png"}), "none.xml", 1);
  refused(silvavis({"render", forest, "--eye", "1,2", "--look-at", "1,2,3", "-o", folder / "b.png"}), "--eye");
  refused(silvavis({"render", forest, "--drape", folder / "none.tif", "-o", folder / "b.png"}), "none.tif");
}

// Every plant's number in an EXR names the row of the exported table whose crown holds the point that is seen.
TEST(Channels, PlantsAreThoseOfTheExport) {
  const Folder folder;
  const std::string forest = grown("06-layers");
  const auto e = ecosystem::read(forest);
  const View view = over("06-layers");
  ASSERT_EQ(silvavis({"render",
                      forest,
                      "--eye",
                      View::text(view.eye),
                      "--look-at",
                      View::text(view.look_at),
                      "--fov",
                      "60",
                      "--size",
                      "240x160",
                      "--spp",
                      "1",
                      "--triangles",
                      "12000",
                      "--lod",
                      "off",
                      "--aov",
                      "depth,species,plant-id",
                      "-q",
                      "-o",
                      folder / "f.exr"})
                .code,
            0);
  ASSERT_EQ(silvasim({"export", forest, "-o", folder / "p.csv", "-q"}).code, 0);

  // The table, by number over the sites of all layers.
  std::map<std::string, std::uint64_t> first_plant;
  std::map<std::pair<std::string, std::string>, int> species_number;
  std::uint64_t sites = 0;
  int species = 0;
  for (const auto& layer : e.layers) {
    first_plant[layer.name] = sites;
    sites += layer.plants.size();
    for (const auto& one : layer.species) species_number[{layer.name, one.name}] = species++;
  }
  std::map<std::uint64_t, std::map<std::string, std::string>> rows;
  std::istringstream table(read(folder / "p.csv"));
  std::vector<std::string> names;
  for (std::string line; std::getline(table, line);) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) {
      if (!cell.empty() && cell.back() == '\r') cell.pop_back();
      cells.push_back(cell);
    }
    if (names.empty()) {
      names = cells;
      continue;
    }
    std::map<std::string, std::string> values;
    for (std::size_t i = 0; i < cells.size(); ++i) values[names[i]] = cells[i];
    rows[first_plant[values["layer"]] + std::stoull(values["id"])] = values;
  }

  const silvavis::image::Frame frame = silvavis::image::read_frame(folder / "f.exr");
  silvavis::shade::Camera camera;
  camera.eye = view.eye;
  camera.look_at = view.look_at;
  camera.fov_deg = 60;
  camera.width = 240;
  camera.height = 160;
  const auto lens = silvavis::shade::lens_of(camera);
  std::set<std::string> layers;
  int seen = 0;
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 240; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * 240 + static_cast<std::size_t>(x);
      const bool plant = frame.plants[i] != silvavis::image::no_plant;
      ASSERT_EQ(plant, frame.species[i] < silvavis::image::species_water);
      if (!plant) continue;
      const auto found = rows.find(frame.plants[i]);
      ASSERT_NE(found, rows.end()) << "plant " << frame.plants[i];
      auto& row = found->second;
      ASSERT_EQ(frame.species[i], (species_number[{row["layer"], row["species"]}]));
      const auto ray = silvavis::shade::ray_through(lens, x + 0.5, y + 0.5);
      const V3d at = ray.origin + V3d(ray.direction) * static_cast<double>(frame.depth.pixels[i]);
      const double radius = std::stod(row["crown_radius_m"]), height = std::stod(row["height_m"]);
      ASSERT_LT(std::hypot(at.x - std::stod(row["x_m"]), at.y - std::stod(row["y_m"])), radius * 1.01 + 0.05);
      const double above = at.z - std::stod(row["z_m"]);
      ASSERT_GT(above, -2);
      ASSERT_LT(above, height * 1.02 + 0.5);
      layers.insert(row["layer"]);
      ++seen;
    }
  }
  EXPECT_GT(seen, 2000);
  EXPECT_EQ(layers.size(), e.layers.size());

  // And `info` tells the same numbers.
  const auto info = silvavis({"info", forest, "--triangles", "12000", "--json", "-q"}).json();
  for (const auto& layer : info["layers"]) {
    EXPECT_EQ(layer["first_plant"], first_plant[layer["name"]]);
    for (const auto& one : layer["species"]) {
      EXPECT_EQ(one["number"], (species_number[{layer["name"], one["name"]}]));
      std::uint64_t count = 0;
      for (auto& [number, row] : rows) count += row["layer"] == layer["name"] && row["species"] == one["name"];
      EXPECT_EQ(one["plants"], count) << one["name"];
      if (count > 0) {
        EXPECT_EQ(one["source"], "grown");
        EXPECT_GT(one["models"][0]["triangles"].get<int>(), 0);
      }
    }
  }
}

TEST(Land, WaterLiesWhereItsPolygonsAre) {
  const Folder folder;
  const std::string forest = grown("02-elevation");
  const View view = over("02-elevation");
  const double west = view.look_at.x - 20, east = west + 50, south = view.look_at.y - 10, north = south + 30;
  const auto p = [](double x, double y) { return "[" + std::to_string(x) + "," + std::to_string(y) + "]"; };
  write(folder / "w.geojson",
        R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::25832"}},)"
        R"("features":[{"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":[[)" +
            p(west, south) + "," + p(east, south) + "," + p(east, north) + "," + p(west, north) + "," + p(west, south) +
            "]]}}]}");
  ASSERT_EQ(silvavis({"render",
                      forest,
                      "--eye",
                      View::text(view.eye),
                      "--look-at",
                      View::text(view.look_at),
                      "--fov",
                      "60",
                      "--size",
                      "160x100",
                      "--spp",
                      "1",
                      "--triangles",
                      "12000",
                      "--aov",
                      "depth,species",
                      "--water",
                      folder / "w.geojson",
                      "-q",
                      "-o",
                      folder / "f.exr"})
                .code,
            0);
  const silvavis::image::Frame frame = silvavis::image::read_frame(folder / "f.exr");
  silvavis::shade::Camera camera;
  camera.eye = view.eye;
  camera.look_at = view.look_at;
  camera.fov_deg = 60;
  camera.width = 160;
  camera.height = 100;
  const auto lens = silvavis::shade::lens_of(camera);
  int water = 0, ground = 0;
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 160; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * 160 + static_cast<std::size_t>(x);
      const bool is_water = frame.species[i] == silvavis::image::species_water;
      if (!is_water && frame.species[i] != silvavis::image::species_ground) continue;
      const auto ray = silvavis::shade::ray_through(lens, x + 0.5, y + 0.5);
      const V3d at = ray.origin + V3d(ray.direction) * static_cast<double>(frame.depth.pixels[i]);
      const double inside = std::min({at.x - west, east - at.x, at.y - south, north - at.y});
      if (std::abs(inside) < 1.5) continue;  // the water's cells are about a metre wide
      ASSERT_EQ(is_water, inside > 0) << at.x << " " << at.y;
      ++(is_water ? water : ground);
    }
  }
  EXPECT_GT(water, 20);
  EXPECT_GT(ground, 200);
}

TEST(Land, LooksAsAskedFor) {
  const Folder folder;
  const std::string forest = grown("03-soils-and-classes");
  const auto render = [&](const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> arguments{"render", forest, "--spp", "1", "-o", folder / name};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return quick(arguments);
  };
  std::set<std::string> pictures;
  ASSERT_EQ(render("plain.exr", {}).code, 0);
  ASSERT_EQ(render("grey.exr", {"--hillshade"}).code, 0);
  ASSERT_EQ(render("soil.exr", {"--classes", source("data/soil.tif")}).code, 0);
  write(folder / "c.csv", "code,soil,colour\n1,alluvium,#203040\n2,\"loam, loess\",#806040\n");
  const Outcome own =
      silvavis({"render", forest, "--spp", "1", "--size", "64x36", "--triangles", "12000", "--classes",
                source("data/soil.tif"), "--class-colours", folder / "c.csv", "-o", folder / "own.exr"});
  ASSERT_EQ(own.code, 0) << own.err;
  EXPECT_THAT(own.err, HasSubstr("classes without a colour are shown as plain land: 3"));
  ASSERT_EQ(render("drape.exr", {"--drape", source("data/water.png")}).code, 0);
  for (const char* name : {"plain.exr", "grey.exr", "soil.exr", "own.exr", "drape.exr"})
    EXPECT_TRUE(pictures.insert(read(folder / name)).second) << name;

  EXPECT_EQ(render("x.exr", {"--hillshade", "--drape", source("data/water.png")}).code, 2);
  EXPECT_EQ(render("x.exr", {"--class-colours", folder / "c.csv"}).code, 2);
  EXPECT_EQ(render("x.exr", {"--water", source("data/waters.geojson"), "--water-width", "nan"}).code, 2);
  EXPECT_THAT(render("x.exr", {"--drape", source("data/elevation.tif")}).err, HasSubstr("and a picture 8 or 16 bits"));
  EXPECT_THAT(render("x.exr", {"--classes", source("data/moisture.tif")}).err, HasSubstr("has no palette"));
  EXPECT_THAT(render("x.exr", {"--water", source("data/landuse.gpkg") + "#nothing"}).err, HasSubstr("nothing"));
  write(folder / "c.csv", "1,alluvium,#20304\n");
  const Outcome bad = render("x.exr", {"--classes", source("data/soil.tif"), "--class-colours", folder / "c.csv"});
  EXPECT_EQ(bad.code, 2);
  EXPECT_THAT(bad.err, HasSubstr("c.csv:1: error: \"#20304\" is no colour"));
}

}  // namespace
}  // namespace silvasim::cases
