#include "ghosttile/tile/file.h"

#include <gtest/gtest.h>

#include "ghosttile/objects/made/made.h"
#include "ghosttile/objects/make_detail.h"
#include "ghosttile/tile/create.h"
#include "silvasim/base/error.h"
#include "silvasim/base/random.h"

namespace ghosttile::tile {
namespace {

GhostTile small_tile() {
  objects::made::MadeOptions leaf;
  leaf.form = objects::made::made_forms()[0].name;
  objects::SphereFitOptions fit;
  fit.spheres = 6;
  CreateOptions options;
  options.side_m = 0.3f;
  options.delta_m = -0.001f;
  options.seed = 3;
  options.spreads.resize(1);
  options.spreads[0].count = 30;
  options.spreads[0].tilts = {{0, 40, 1}};
  return create({objects::make_detail("leaf", objects::made::make(leaf), fit, {})}, options);
}

GhostTile from(const Bytes& bytes) {
  return tile_from(chunks_from(bytes, "t.ghost", tile_type, "Ghost Tile"), "t.ghost");
}

TEST(GhostFile, ReadsWhatWasWritten) {
  const GhostTile tile = small_tile();
  const Bytes bytes = file_bytes(chunks_of(tile));
  const GhostTile back = from(bytes);
  EXPECT_EQ(back.side_m, tile.side_m);
  EXPECT_EQ(back.delta_m, tile.delta_m);
  EXPECT_EQ(back.seed, tile.seed);
  EXPECT_EQ(back.candidates, tile.candidates);
  EXPECT_EQ(back.graph, tile.graph);
  ASSERT_EQ(back.objects.size(), tile.objects.size());
  EXPECT_EQ(back.objects[0].spheres, tile.objects[0].spheres);
  EXPECT_EQ(back.objects[0].model.positions, tile.objects[0].model.positions);
  EXPECT_EQ(back.objects[0].model.triangles, tile.objects[0].model.triangles);
  EXPECT_EQ(back.objects[0].model.materials, tile.objects[0].model.materials);
  EXPECT_EQ(back.objects[0].model.textures, tile.objects[0].model.textures);
  // Which says it of every byte.
  EXPECT_EQ(file_bytes(chunks_of(back)), bytes);
}

TEST(GhostFile, RefusesEveryTruncationAndEveryFlippedBitInOneLine) {
  const Bytes bytes = file_bytes(chunks_of(small_tile()));
  const auto refused = [](const Bytes& damaged, const std::string& how) {
    try {
      from(damaged);
      ADD_FAILURE() << how;
    } catch (const silvasim::base::Error& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << how;
    }
  };
  silvasim::base::Stream stream(7, silvasim::base::Purpose::picture);
  for (int i = 0; i < 300; ++i) {
    const std::size_t at = stream.next_below(static_cast<std::uint32_t>(bytes.size()));
    refused(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(at)), "cut at " + std::to_string(at));
    Bytes flipped = bytes;
    flipped[at] ^= std::byte{1} << stream.next_below(8);
    refused(flipped, "flipped at " + std::to_string(at));
  }
}

// Damage that checksums do not find: what was written so. Whatever is read keeps its promises.
TEST(GhostFile, RefusesWrongContentWithRightChecksums) {
  const std::vector<NamedChunk> chunks = chunks_of(small_tile());
  silvasim::base::Stream stream(8, silvasim::base::Purpose::picture);
  int taken = 0;
  for (int i = 0; i < 2000; ++i) {
    std::vector<NamedChunk> damaged = chunks;
    NamedChunk& chunk = damaged[stream.next_below(static_cast<std::uint32_t>(damaged.size()))];
    const std::uint32_t at =
        stream.next_below(static_cast<std::uint32_t>(std::min<std::size_t>(chunk.content.size(), 4000)));
    chunk.content[at] = static_cast<std::byte>(stream.next_below(256));
    if (i % 5 == 0) chunk.content.resize(at);
    try {
      const GhostTile tile = from(file_bytes(damaged));
      ++taken;
      EXPECT_EQ(tile.graph.problem(), "");
      for (const Candidate& candidate : tile.candidates) ASSERT_LT(candidate.object, tile.objects.size());
    } catch (const silvasim::base::Error&) {
    }
  }
  EXPECT_LT(taken, 1900);
  EXPECT_GT(taken, 0);
}

TEST(GhostFile, SaysWhatAnotherFileIs) {
  NamedChunk other;
  other.type = {'M', 'E', 'T', 'A'};
  try {
    from(file_bytes({other}));
    FAIL();
  } catch (const silvasim::base::Error& error) {
    EXPECT_STREQ(error.what(), "t.ghost: this is no Ghost Tile, but another file of Silva");
  }
}

}  // namespace
}  // namespace ghosttile::tile
