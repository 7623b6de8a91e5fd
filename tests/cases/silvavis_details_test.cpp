// silvavis with --details: what is filled is seen, counted and named, and wrong files are told at once.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "ghosttile/density/ground_plane.h"
#include "ghosttile/density/node.h"
#include "ghosttile/fill/file.h"
#include "ghosttile/fill/fill.h"
#include "ghosttile/objects/made/made.h"
#include "ghosttile/objects/make_detail.h"
#include "ghosttile/tile/create.h"
#include "silvasim/ecosystem/file.h"
#include "silvavis/image/file.h"
#include "tests/cases/silvavis_program.h"

namespace silvasim::cases {
namespace {

using silvavis::V3d;
using ::testing::HasSubstr;
namespace fill = ghosttile::fill;

// Leaves and stones on the land around a point.
fill::DetailsFile litter(const ecosystem::Ecosystem& land, const V3d& middle, double half_m) {
  namespace objects = ghosttile::objects;
  std::vector<objects::Detail> things;
  ghosttile::tile::CreateOptions options;
  options.delta_m = -0.01f;
  for (const char* form : {"maple-leaf", "stone"}) {
    objects::made::MadeOptions made;
    made.form = form;
    things.push_back(objects::make_detail(form, objects::made::make(made), {.spheres = 8}, {}));
    ghosttile::tile::Spread spread;
    spread.count = things.size() == 1 ? 300 : 30;
    spread.tilts = {{0, 30, 1}};
    options.spreads.push_back(spread);
  }
  fill::Plan plan;
  plan.tile = std::make_shared<ghosttile::tile::GhostTile>(ghosttile::tile::create(things, options));
  plan.ground = ghosttile::density::ground_plane(land.terrain);
  for (int k = 0; k < 2; ++k) {
    ghosttile::density::Node layer;
    layer.kind = ghosttile::density::Kind::layer;
    layer.plane = plan.ground;
    layer.from_m = 0;
    layer.to_m = 0.06;
    fill::ObjectRule rule;
    rule.density = ghosttile::density::Field(layer);
    plan.objects.push_back(rule);
  }
  fill::DetailsFile file;
  file.tile = plan.tile;
  const V3d half(half_m, half_m, 100);
  file.filled = fill::tiles_within(plan, {middle - half, middle + half});
  file.details = fill::fill(plan, file.filled);
  return file;
}

TEST(Details, AreSeenWhereTheyStandAndBearTheirNumbers) {
  const Folder folder;
  const std::string forest = grown("02-elevation");
  const auto e = ecosystem::read(forest);
  V3d middle(std::round((e.extent.west + e.extent.east) / 2), std::round((e.extent.south + e.extent.north) / 2), 0);
  middle.z = ecosystem::height_at(e.terrain, {middle.x, middle.y});
  const fill::DetailsFile file = litter(e, middle, 4);
  ASSERT_GT(file.details.count(), 1000u);
  fill::write(file, folder / "litter.details");
  const V3d eye = middle + V3d(-1.5, -2, 1.4);
  const auto text = [](const V3d& p) {
    return std::to_string(p.x) + "," + std::to_string(p.y) + "," + std::to_string(p.z);
  };
  const auto picture = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render",
                                       forest,
                                       "--eye",
                                       text(eye),
                                       "--look-at",
                                       text(middle),
                                       "--spp",
                                       "1",
                                       "--lod",
                                       "off",
                                       "--no-shadows",
                                       "--model",
                                       e.layers[0].species[0].name + "=none",
                                       "--aov",
                                       "depth,normal,species,plant-id",
                                       "-o",
                                       folder / name};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = quick(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return silvavis::image::read_frame(folder / name);
  };
  const auto with = picture("with.exr", {"--details", folder / "litter.details"});
  const auto without = picture("without.exr", {});
  const auto flat = picture("flat.exr", {"--details", folder / "litter.details", "--backend", "embree"});

  const Outcome told =
      silvavis({"info", forest, "--details", folder / "litter.details", "--json", "--triangles", "1000", "-q"});
  ASSERT_EQ(told.code, 0) << told.err;
  const auto json = told.json()["details"][0];
  EXPECT_EQ(json["instances"], file.details.count());
  EXPECT_EQ(json["objects"][1], "stone");
  const std::uint32_t first_plant = json["first_plant"], first_object = json["first_object"];
  EXPECT_EQ(first_object, e.layers[0].species.size());

  // Each number names an instance of the file that reaches to what is seen.
  std::vector<std::pair<std::size_t, std::uint16_t>> instances;
  for (std::size_t t = 0; t < file.details.tiles.size(); ++t)
    for (const std::uint16_t c : file.details.of(t)) instances.emplace_back(t, c);
  std::size_t details = 0, other = 0, stones = 0;
  for (std::size_t i = 0; i < with.plants.size(); ++i) {
    other += with.plants[i] == flat.plants[i] ? 0 : 1;
    if (with.plants[i] == silvavis::image::no_plant || with.plants[i] < first_plant) continue;
    ++details;
    ASSERT_LT(with.plants[i] - first_plant, instances.size());
    const auto [t, c] = instances[with.plants[i] - first_plant];
    const auto& candidate = file.tile->candidates[c];
    EXPECT_EQ(with.species[i], first_object + candidate.object);
    stones += candidate.object == 1 ? 1 : 0;
    const auto& tile = file.details.tiles[t];
    const double side = static_cast<double>(file.tile->side_m);
    const V3d at = V3d(tile.x, tile.y, tile.z) * side + V3d(candidate.at);
    const double away = (at - eye).length(), depth = static_cast<double>(with.depth.pixels[i]);
    EXPECT_NEAR(depth, away, 0.25);
    // What is seen of the land behind is farther.
    if (without.species[i] == silvavis::image::species_ground) {
      EXPECT_LT(depth, static_cast<double>(without.depth.pixels[i]) + 0.05);
    }
  }
  EXPECT_GT(details, 300u);
  EXPECT_GT(stones, 20u);
  EXPECT_LE(other, with.plants.size() / 200) << "the backends should see the same";
}

TEST(Details, AreReadBeforeModelsAreMadeAndNeverOverwritten) {
  const Folder folder;
  const std::string forest = grown("02-elevation");
  const auto refused = [&](const std::string& command, const std::string& file, const char* what) {
    std::vector<std::string> arguments{command, forest, "--details", file, "--triangles", "1000"};
    if (command == "render") arguments.insert(arguments.end(), {"-o", folder / "a.png"});
    const Outcome outcome = silvavis(arguments);
    EXPECT_NE(outcome.code, 0);
    EXPECT_THAT(outcome.err, testing::AllOf(HasSubstr(what), HasSubstr(file), testing::Not(HasSubstr("models"))));
  };
  for (const char* command : {"render", "info"}) refused(command, folder / "none.details", "none.details");
  refused("render", forest, "details");
  const auto e = ecosystem::read(forest);
  V3d middle((e.extent.west + e.extent.east) / 2, (e.extent.south + e.extent.north) / 2, 0);
  middle.z = ecosystem::height_at(e.terrain, {middle.x, middle.y});
  fill::write(litter(e, middle, 1), folder / "litter.details");
  std::string bytes = read(folder / "litter.details");
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 4);
  write(folder / "damaged.details", bytes);
  refused("render", folder / "damaged.details", "damaged.details");
  // Details of another place are told.
  const V3d elsewhere = middle + V3d(50000, 0, 0);
  fill::write(litter(e, {elsewhere.x, elsewhere.y, ecosystem::height_at(e.terrain, {elsewhere.x, elsewhere.y})}, 1),
              folder / "elsewhere.details");
  const Outcome outcome = silvavis({"render", forest, "--details", folder / "elsewhere.details", "--size", "16x9",
                                    "--spp", "1", "--triangles", "1000", "-o", folder / "b.png"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("lie outside of the ecosystem"));
  std::filesystem::create_symlink(folder / "litter.details", folder / "c.png");
  EXPECT_NE(quick({"render", forest, "--details", folder / "litter.details", "-o", folder / "c.png"}).code, 0);
}

}  // namespace
}  // namespace silvasim::cases
