#include "ghosttile/fill/file.h"

#include <gtest/gtest.h>

#include "ghosttile/density/node.h"
#include "ghosttile/fill/edit.h"
#include "ghosttile/tile/create.h"
#include "silvasim/base/error.h"
#include "silvasim/base/random.h"
#include "tests/unit/ghosttile/tile/made_details.h"

namespace ghosttile::fill {
namespace {

Plan small_plan(double radius_m) {
  tile::CreateOptions options;
  options.side_m = 0.4f;
  options.spreads.resize(1);
  options.spreads[0].count = 70;
  objects::Detail lump = tile::lump(0.05f, 6, 1);
  lump.model.positions = {{0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}};
  lump.model.normals.assign(3, {0, 0, 1});
  lump.model.uvs.assign(3, {0, 0});
  lump.model.triangles = {{0, 1, 2}};
  lump.model.triangle_materials = {0};
  lump.model.materials.resize(1);
  Plan plan;
  plan.tile = std::make_shared<tile::GhostTile>(tile::create({lump}, options));
  plan.objects.resize(1);
  density::Node ball;
  ball.kind = density::Kind::sphere;
  ball.points = {{0, 0, 0}};
  ball.size.x = radius_m;
  density::Node half;
  half.kind = density::Kind::scale;
  half.value = 0.6f;
  half.children = {ball};
  plan.objects[0].density = density::Field(half);
  return plan;
}

DetailsFile small_file() {
  const Plan plan = small_plan(1.2);
  DetailsFile file;
  file.tile = plan.tile;
  file.filled = tiles_of(plan);
  file.scene = "scene.xml";
  file.scene_sha256 = "abc";
  file.crs_wkt = "LOCAL";
  file.details = fill(plan, file.filled);
  edit(small_plan(0.7), file, tiles_of(plan), "<strokes/>");
  return file;
}

TEST(DetailsFile, ReadsWhatWasWritten) {
  const DetailsFile file = small_file();
  ASSERT_GT(file.edits[0].before.count(), 100u);
  ASSERT_GT(file.details.chosen.size(), file.details.count());
  const auto bytes = to_bytes(file);
  const DetailsFile back = from_bytes(bytes, "a.details");
  EXPECT_EQ(back.details, file.details);
  EXPECT_EQ(back.edits, file.edits);
  EXPECT_EQ(back.filled, file.filled);
  EXPECT_EQ(back.scene, file.scene);
  EXPECT_EQ(back.scene_sha256, file.scene_sha256);
  EXPECT_EQ(back.crs_wkt, file.crs_wkt);
  EXPECT_EQ(to_bytes(back), bytes);
}

TEST(DetailsFile, RefusesEveryTruncationAndEveryFlippedBitInOneLine) {
  const auto bytes = to_bytes(small_file());
  silvasim::base::Stream stream(3, silvasim::base::Purpose::picture);
  const auto refused = [](const std::vector<std::byte>& damaged, std::size_t at) {
    try {
      from_bytes(damaged, "a.details");
      ADD_FAILURE() << at;
    } catch (const silvasim::base::Error& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << at;
    }
  };
  for (int i = 0; i < 200; ++i) {
    const std::size_t at = stream.next_below(static_cast<std::uint32_t>(bytes.size()));
    refused({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(at)}, at);
    auto flipped = bytes;
    flipped[at] ^= std::byte{1} << stream.next_below(8);
    refused(flipped, at);
  }
}

// What no checksum finds: two that collide, tiles out of order, a candidate that is none.
TEST(DetailsFile, RefusesContentThatBreaksItsPromises) {
  const DetailsFile good = small_file();
  const auto refused = [](const DetailsFile& file, const std::string& what) {
    try {
      from_bytes(to_bytes(file), "a.details");
      ADD_FAILURE() << what;
    } catch (const silvasim::base::Error& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  DetailsFile file = good;
  std::swap(file.details.tiles[0], file.details.tiles[1]);
  refused(file, "its tiles are out of order");
  file = good;
  file.details.chosen[0] = 70;
  refused(file, "none of the Ghost Tile's");
  file = good;
  file.details.instances[0] = 60000;
  refused(file, "more instances than places");
  // Put a candidate in that collides with one that stands.
  file = good;
  for (std::uint32_t c = 0; c < 70; ++c) {
    if (!good.tile->graph.collides(good.details.chosen[0], c, {0, 0, 0})) continue;
    Details with;
    with.first = {0, 2};
    with.tiles = {good.details.tiles[0]};
    with.chosen = {std::min(good.details.chosen[0], static_cast<std::uint16_t>(c)),
                   std::max(good.details.chosen[0], static_cast<std::uint16_t>(c))};
    with.instances = {2};
    file.details = with;
    refused(file, "two of its instances collide");
    break;
  }
}

}  // namespace
}  // namespace ghosttile::fill
