// A damaged or hostile file is refused with what is wrong and where; never read partly, never a crash.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <limits>
#include <string>

#include "random_ecosystem.h"
#include "silvasim/base/error.h"
#include "silvasim/ecosystem/file.h"
#include "surgery.h"

namespace silvasim::ecosystem {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
using testing::ThrowsMessage;

constexpr std::uint64_t huge = std::numeric_limits<std::uint64_t>::max();

// The message, or an empty string where the file was read.
std::string refusal(std::span<const std::byte> bytes) {
  try {
    from_bytes(bytes, "test.silva");
  } catch (const base::Error& error) {
    return error.what();
  }
  return {};
}

void expect_refused(const Anatomy& anatomy, const std::string& what) {
  EXPECT_THAT(refusal(put_together(anatomy)), AllOf(StartsWith("test.silva: "), HasSubstr(what)));
}

Anatomy small_anatomy() { return take_apart(to_bytes(small_ecosystem())); }

void store_at(FileBytes& bytes, std::size_t at, auto number) { std::memcpy(bytes.data() + at, &number, sizeof number); }

TEST(Damage, TheSurgeonLeavesHealthyFilesAsTheyWere) {
  const auto bytes = to_bytes(small_ecosystem());
  EXPECT_EQ(put_together(take_apart(bytes)), bytes);
  Random random(1);
  for (int i = 0; i < 20; ++i) {
    const auto other = to_bytes(random_ecosystem(random));
    EXPECT_EQ(put_together(take_apart(other)), other);
  }
}

TEST(Damage, EveryTruncationIsRefused) {
  const auto bytes = to_bytes(small_ecosystem());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    ASSERT_THAT(refusal(std::span(bytes).first(size)), StartsWith("test.silva: ")) << size << " of " << bytes.size();
  }
  ASSERT_EQ(refusal(bytes), "");
}

TEST(Damage, EveryAddedOrLostByteIsRefused) {
  const auto bytes = to_bytes(small_ecosystem());
  for (std::size_t at = 0; at <= bytes.size(); ++at) {
    auto more = bytes;
    more.insert(more.begin() + static_cast<std::ptrdiff_t>(at), std::byte{0});
    ASSERT_NE(refusal(more), "") << "added at " << at;
    if (at == bytes.size()) break;
    auto less = bytes;
    less.erase(less.begin() + static_cast<std::ptrdiff_t>(at));
    ASSERT_NE(refusal(less), "") << "lost at " << at;
  }
}

TEST(Damage, EveryFlippedBitIsRefused) {
  auto bytes = to_bytes(small_ecosystem());
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    const std::byte mask{static_cast<unsigned char>(1 << bit % 8)};
    bytes[bit / 8] ^= mask;
    ASSERT_NE(refusal(bytes), "") << "bit " << bit % 8 << " of byte " << bit / 8 << " of " << bytes.size();
    bytes[bit / 8] ^= mask;
  }
  ASSERT_EQ(refusal(bytes), "");
}

// With all checksums mended, so that the checks behind them have to hold: either an error, or an ecosystem that is
// valid (from_bytes promises it, and to_bytes refuses what is not).
TEST(Damage, EveryFlippedBitOfEveryContentIsRefusedOrMakesSense) {
  const Anatomy healthy = small_anatomy();
  std::size_t refused = 0, read = 0;
  for (std::size_t p = 0; p < healthy.parts.size(); ++p) {
    for (std::size_t bit = 0; bit < 8 * healthy.parts[p].content.size(); ++bit) {
      Anatomy anatomy = healthy;
      anatomy.parts[p].content[bit / 8] ^= std::byte{static_cast<unsigned char>(1 << bit % 8)};
      const auto bytes = put_together(anatomy);
      if (!refusal(bytes).empty()) {
        ++refused;
        continue;
      }
      ++read;
      const Ecosystem ecosystem = from_bytes(bytes, "test.silva");
      ASSERT_TRUE(from_bytes(to_bytes(ecosystem), "again") == ecosystem) << healthy.parts[p].type << " bit " << bit;
    }
  }
  EXPECT_GT(refused, 100u);
  EXPECT_GT(read, 100u);
}

TEST(Damage, NamesFileChunkAndByte) {
  auto bytes = to_bytes(small_ecosystem());
  const auto table = number_at<std::uint64_t>(bytes, bytes.size() - 40);
  // The fourth chunk of the table, by its offset.
  const auto offset = number_at<std::uint64_t>(bytes, table + 3 * 56 + 24);
  const std::string type(reinterpret_cast<const char*>(bytes.data() + table + 3 * 56), 4);
  bytes[offset] ^= std::byte{1};
  EXPECT_EQ(refusal(bytes), "test.silva: chunk " + type + " at byte " + std::to_string(offset) +
                                ": its checksum differs; the file is damaged");
}

TEST(Damage, OtherFilesAreToldApart) {
  const std::string text =
      "PK\3\4 a zip archive, a picture, anything that is longer than a header and a footer together";
  EXPECT_THAT(refusal(std::as_bytes(std::span(text))), HasSubstr("no file of Silva"));
  EXPECT_THAT(refusal({}), HasSubstr("no file of Silva"));
  Anatomy anatomy = small_anatomy();
  anatomy.endian_tag = 0x04030201;
  expect_refused(anatomy, "endian tag");
}

TEST(Versions, AnOtherMajorVersionIsRefusedNamingBoth) {
  Anatomy anatomy = small_anatomy();
  anatomy.major = 2;
  anatomy.minor = 5;
  expect_refused(anatomy, "version 2.5; this program reads version 1.0, a newer program is needed");
  anatomy.major = 0;
  expect_refused(anatomy, "version 0.5; this program reads version 1.0");
}

TEST(Versions, ANewerMinorVersionIsReadWithoutItsOptionalChunks) {
  Anatomy anatomy = small_anatomy();
  anatomy.minor = 9;
  anatomy.parts.insert(anatomy.parts.begin() + 2, Part{.type = "NEWS", .flags = 1, .content = FileBytes(100)});
  anatomy.parts.push_back(
      Part{.type = "AGES", .flags = 1, .codec = 77, .layer = 0, .first_row = 3, .rows = 9, .content = FileBytes(50)});
  EXPECT_TRUE(from_bytes(put_together(anatomy), "test.silva") == small_ecosystem());

  anatomy.parts[2].flags = 0;
  expect_refused(anatomy, "chunk NEWS at byte");
  expect_refused(anatomy, "the file is of format version 1.9, this program knows version 1.0");
  anatomy.parts[2].flags = 2;
  expect_refused(anatomy, "must not be skipped");
  anatomy.parts[2].flags = 1;
  anatomy.parts[2].checksum = 1;
  expect_refused(anatomy, "chunk NEWS at byte");
}

TEST(Chunks, MissingOnesAreNamed) {
  const Anatomy healthy = small_anatomy();
  for (std::size_t p = 0; p < healthy.parts.size(); ++p) {
    Anatomy anatomy = healthy;
    anatomy.parts.erase(anatomy.parts.begin() + static_cast<std::ptrdiff_t>(p));
    if (healthy.parts[p].type == "SUIT") {
      EXPECT_TRUE(from_bytes(put_together(anatomy), "test.silva").layers[0].suitability.empty()) << "it is optional";
      continue;
    }
    expect_refused(anatomy, healthy.parts[p].type);
    expect_refused(anatomy, "missing");
  }
  Anatomy empty;
  expect_refused(empty, "chunk META is missing");
}

TEST(Chunks, DuplicatesAreRefused) {
  const Anatomy healthy = small_anatomy();
  for (const Part& part : healthy.parts) {
    Anatomy anatomy = healthy;
    anatomy.parts.push_back(part);
    expect_refused(anatomy, "chunk " + part.type);
  }
}

TEST(Chunks, AnyOrderOfTheOnesThatAreNoBandsIsRead) {
  Anatomy anatomy = small_anatomy();
  std::reverse(anatomy.parts.begin(), anatomy.parts.end());
  EXPECT_TRUE(from_bytes(put_together(anatomy), "test.silva") == small_ecosystem());
}

TEST(Chunks, OverlapsAndGapsAreRefused) {
  const Anatomy healthy = small_anatomy();
  for (std::size_t p = 0; p < healthy.parts.size(); ++p) {
    for (const std::uint64_t offset :
         {std::uint64_t{0}, std::uint64_t{p == 0 ? 25u : 24u}, std::uint64_t{1000000}, huge - 3, huge}) {
      Anatomy anatomy = healthy;
      anatomy.parts[p].offset = offset;
      if (put_together(anatomy) == put_together(healthy)) continue;
      expect_refused(anatomy, "neither overlap nor leave gaps");
    }
  }
  Anatomy anatomy = healthy;
  anatomy.before_table = FileBytes(5);
  expect_refused(anatomy, "the last chunk ends");
}

TEST(Chunks, LengthsOfZeroAndWithoutBoundAreRefused) {
  const Anatomy healthy = small_anatomy();
  for (std::size_t p = 0; p < healthy.parts.size(); ++p) {
    const std::uint64_t size = healthy.parts[p].content.size();
    for (const std::uint64_t lie :
         {std::uint64_t{0}, size - 1, size + 1, std::uint64_t{1} << 31, std::uint64_t{1} << 62, huge - 100, huge}) {
      Anatomy anatomy = healthy;
      anatomy.parts[p].content_size = lie;
      expect_refused(anatomy, "chunk " + healthy.parts[p].type);
      anatomy = healthy;
      anatomy.parts[p].stored_size = lie;
      expect_refused(anatomy, "byte ");
    }
    Anatomy anatomy = healthy;
    anatomy.parts[p].stored = FileBytes{};
    expect_refused(anatomy, "chunk " + healthy.parts[p].type);
    anatomy = healthy;
    anatomy.parts[p].content.clear();
    expect_refused(anatomy, "chunk " + healthy.parts[p].type);
    anatomy = healthy;
    anatomy.parts[p].codec = 0;
    anatomy.parts[p].content.push_back(std::byte{0});
    anatomy.parts[p].content_size = size;
    expect_refused(anatomy, "chunk " + healthy.parts[p].type);
  }
}

// zstd itself would read a second frame on.
TEST(Chunks, HoldOneFrameAndNothingElse) {
  const Anatomy healthy = small_anatomy();
  for (std::size_t p = 0; p < healthy.parts.size(); ++p) {
    for (const FileBytes& more : {FileBytes(1), squeezed({})}) {
      Anatomy anatomy = healthy;
      anatomy.parts[p].stored = squeezed(healthy.parts[p].content);
      anatomy.parts[p].stored->insert(anatomy.parts[p].stored->end(), more.begin(), more.end());
      expect_refused(anatomy, "its zstd frame ends after");
    }
  }
}

TEST(Chunks, AnyChunkMayBeStoredAsItIs) {
  Anatomy anatomy = small_anatomy();
  for (Part& part : anatomy.parts) part.codec = 0;
  EXPECT_TRUE(from_bytes(put_together(anatomy), "test.silva") == small_ecosystem());
}

TEST(Chunks, EntriesWithWhatIsUnknownAreRefused) {
  const Anatomy healthy = small_anatomy();
  const auto expect = [&](const std::string& what, auto spoil) {
    for (const char* type : {"META", "SPEC", "PLNT"}) {
      Anatomy anatomy = healthy;
      spoil(anatomy.part(type));
      expect_refused(anatomy, what);
    }
  };
  expect("must be zero", [](Part& part) { part.first_zero = 1; });
  expect("must be zero", [](Part& part) { part.second_zero = 1; });
  expect("flags are 1", [](Part& part) { part.flags = 1; });
  expect("flags are 32768", [](Part& part) { part.flags = 32768; });
  expect("(2) that is unknown", [](Part& part) { part.codec = 2; });
  expect("checksum", [](Part& part) { part.checksum = 0; });
  Anatomy anatomy = healthy;
  anatomy.part("SPEC").layer = 0xFFFFFFFF;
  expect_refused(anatomy, "belongs to no layer, but should");
  anatomy = healthy;
  anatomy.part("META").layer = 0;
  expect_refused(anatomy, "belongs to a layer, but should not");
  for (const std::uint32_t layer : {1u, 5u, 1000000u, 0xFFFFFFFEu}) {
    anatomy = healthy;
    anatomy.part("SPEC").layer = layer;
    EXPECT_NE(refusal(put_together(anatomy)), "") << layer;
  }
  anatomy = healthy;
  anatomy.part("SPEC").rows = 1;
  expect_refused(anatomy, "it is no band");
}

TEST(Footer, LiesAreRefused) {
  const Anatomy healthy = small_anatomy();
  const auto expect = [&](const std::string& what, auto spoil) {
    Anatomy anatomy = healthy;
    spoil(anatomy);
    expect_refused(anatomy, what);
  };
  for (const std::uint64_t lie : {std::uint64_t{0}, std::uint64_t{23}, std::uint64_t{25}, huge / 2, huge - 40, huge}) {
    expect("cannot lie at byte", [lie](Anatomy& a) { a.table_offset = lie; });
    expect("should have", [lie](Anatomy& a) { a.file_size = lie; });
  }
  for (const std::uint32_t lie : {0u, 1u, 100000u, 0xFFFFFFFFu}) {
    expect("cannot lie at byte", [lie](Anatomy& a) { a.count = lie; });
  }
  expect("must be zero", [](Anatomy& a) { a.footer_zero = 1; });
  expect("hash differs", [](Anatomy& a) { a.hash = 5; });
}

// A frame of a few bytes that unfolds to gigabytes of zeros.
FileBytes bomb(std::size_t size) {
  FileBytes stored(1 << 20);
  ZSTD_CCtx* context = ZSTD_createCCtx();
  ZSTD_CCtx_setPledgedSrcSize(context, size);
  const FileBytes zeros(1 << 24);
  ZSTD_outBuffer out{stored.data(), stored.size(), 0};
  for (std::size_t done = 0; done < size; done += zeros.size()) {
    ZSTD_inBuffer in{zeros.data(), zeros.size(), 0};
    while (in.pos < in.size) ZSTD_compressStream2(context, &out, &in, ZSTD_e_continue);
  }
  ZSTD_inBuffer none{nullptr, 0, 0};
  while (ZSTD_compressStream2(context, &out, &none, ZSTD_e_end) != 0) continue;
  ZSTD_freeCCtx(context);
  stored.resize(out.pos);
  return stored;
}

std::size_t peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

TEST(Bombs, AreRefusedBeforeTheyUnfold) {
  constexpr std::size_t size = std::size_t{2} << 30;
  const FileBytes stored = bomb(size);
  ASSERT_LT(stored.size(), 100'000u);
  const Anatomy healthy = small_anatomy();
  const std::size_t before = peak_bytes();
  for (std::size_t p = 0; p < healthy.parts.size(); ++p) {
    // Once with an honest table entry, once with one that claims little.
    Anatomy anatomy = healthy;
    anatomy.parts[p].stored = stored;
    anatomy.parts[p].content_size = size;
    expect_refused(anatomy, "may unfold to");
    anatomy.parts[p].content_size.reset();
    expect_refused(anatomy, "chunk " + healthy.parts[p].type);
  }
  // Many bombs, each of a size that one may have.
  Anatomy many = healthy;
  const FileBytes small_bomb = bomb(std::size_t{48} << 20);
  for (int i = 0; i < 8; ++i) {
    many.parts.push_back(Part{.type = "NEWS", .flags = 1, .stored = small_bomb, .content_size = std::size_t{48} << 20});
  }
  expect_refused(many, "may unfold to");
  EXPECT_LT(peak_bytes() - before, std::size_t{300} << 20);
}

// Counts inside of contents that promise more records than there are bytes.
TEST(Counts, OfMoreThanThereIsAreRefused) {
  const Anatomy healthy = small_anatomy();
  for (const std::uint32_t lie : {0u, 1u, 7u, 0x7FFFFFFFu, 0x80000000u, 0xFFFFFFFFu}) {
    const auto expect = [&](const std::string& type, std::size_t at) {
      Anatomy anatomy = healthy;
      if (number_at<std::uint32_t>(anatomy.part(type).content, at) == lie) return;
      store_at(anatomy.part(type).content, at, lie);
      expect_refused(anatomy, "chunk ");
    };
    expect("META", 0);   // layers
    expect("META", 36);  // length of the name
    expect("SPEC", 0);   // species
    expect("SPEC", 4);   // length of a name
    expect("TSET", 16);  // colours
    expect("TSET", 20);  // variants
    expect("TSET", 24);  // tiles
    expect("TSET", 32);  // sites of the first tile
    expect("TERR", 0);   // columns
    expect("TERR", 4);   // rows
    expect("LAYR", 0);   // length of the name
    expect("LAYR", 25);  // columns
    expect("LAYR", 29);  // rows
    expect("LAYR", 33);  // sites
  }
}

TEST(Values, OutOfRangeAreRefused) {
  const Anatomy healthy = small_anatomy();
  const auto expect = [&](const std::string& what, const std::string& type, std::size_t at, auto number) {
    Anatomy anatomy = healthy;
    store_at(anatomy.part(type).content, at, number);
    expect_refused(anatomy, "chunk " + type);
    expect_refused(anatomy, what);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  expect("extent", "META", 4, nan);
  expect("extent", "META", 4, 1e9);
  expect("1,000,000 km", "META", 4, -1e300);
  expect("1,000,000 km", "META", 4, -1.1e9);
  expect("1,000,000 km", "TERR", 8, 1e300);
  expect("1,000,000 km", "LAYR", 9, -1e300);
  expect("JSON", "PROV", 0, '[');
  expect("finite", "TERR", 8, infinity);
  expect("cells larger than 0", "TERR", 24, -1.0);
  expect("not finite", "LAYR", 9, nan);
  expect("0 or 1", "LAYR", 41, 2u);
  expect("side and largest radius", "TSET", 0, -200.0);
  expect("side and largest radius", "TSET", 8, nan);
  expect("tile 0 has an edge", "TSET", 28, std::uint8_t{250});
  expect("tile 0: site 0 lies at", "TSET", 36, -1.0f);
  expect("tile 0: site 0 lies at", "TSET", 40, static_cast<float>(nan));
  expect("tile 0: site 0 has the radius", "TSET", 44, 0.0f);
  expect("tile 0: site 0 has the radius", "TSET", 44, 1e30f);
  expect("column 0, row 0 of the tiling holds tile 60000", "TLNG", 0, std::uint16_t{60000});
  expect("at byte 1 of its content: species 2 of 2", "PLNT", 1, std::uint8_t{2});
  expect("at byte 0 of its content: species 254 of 2", "PLNT", 0, std::uint8_t{254});

  Anatomy anatomy = healthy;
  std::swap(anatomy.part("PLNT").content[0],
            anatomy.part("PLNT").content[2]);  // a plant for a bare site: the counts hold
  EXPECT_EQ(refusal(put_together(anatomy)), "");
  anatomy.part("PLNT").content[0] = anatomy.part("PLNT").content[2];
  expect_refused(anatomy, "numbers of plants differ");
}

TEST(Values, DeepProvenanceIsRefused) {
  Ecosystem ecosystem = small_ecosystem();
  const auto nested = [](std::size_t levels) {
    return "{\"[\\\"[\":" + std::string(levels - 1, '[') + std::string(levels - 1, ']') + "}";
  };
  ecosystem.provenance_json = nested(64);
  EXPECT_TRUE(from_bytes(to_bytes(ecosystem), "test.silva") == ecosystem);
  for (const std::size_t levels : {65, 20000}) {
    Anatomy anatomy = small_anatomy();
    const std::string text = nested(levels);
    const auto bytes = std::as_bytes(std::span(text));
    anatomy.part("PROV").content.assign(bytes.begin(), bytes.end());
    expect_refused(anatomy, "nested deeper than 64 levels");
  }
}

TEST(Bands, ThatDoNotPartTheRowsAreRefused) {
  Anatomy healthy = small_anatomy();
  // Cut the band of two rows in two.
  const Ecosystem ecosystem = small_ecosystem();
  const Layer& layer = ecosystem.layers[0];
  const std::uint64_t first_row_sites = site_offsets(layer.tile_set, layer.tiling)[3];
  const auto at = static_cast<std::size_t>(
      std::find_if(healthy.parts.begin(), healthy.parts.end(), [](const Part& p) { return p.type == "PLNT"; }) -
      healthy.parts.begin());
  Part north = healthy.parts[at], south = north;
  north.rows = south.rows = south.first_row = 1;
  north.content.resize(first_row_sites);
  south.content.erase(south.content.begin(), south.content.begin() + static_cast<std::ptrdiff_t>(first_row_sites));
  healthy.parts[at] = north;
  healthy.parts.insert(healthy.parts.begin() + static_cast<std::ptrdiff_t>(at) + 1, south);
  ASSERT_TRUE(from_bytes(put_together(healthy), "test.silva") == ecosystem);

  const auto expect = [&](const std::string& what, auto spoil) {
    Anatomy anatomy = healthy;
    spoil(anatomy.parts[at], anatomy.parts[at + 1]);
    expect_refused(anatomy, what);
  };
  expect("holds rows", [](Part& n, Part& s) { std::swap(n, s); });
  expect("holds rows", [](Part&, Part& s) { s.first_row = 0; });
  expect("holds rows", [](Part&, Part& s) { s.rows = 2; });
  expect("holds rows", [](Part&, Part& s) { s.rows = 0xFFFFFFFF; });
  expect("holds rows", [](Part&, Part& s) { s.rows = 0; });
  expect("holds rows", [](Part& n, Part&) { n.first_row = 0xFFFFFFFF; });
  expect("its rows need", [](Part& n, Part&) { n.content.push_back(std::byte{0xFF}); });
  expect("its rows need", [](Part&, Part& s) { s.content.pop_back(); });
}

}  // namespace
}  // namespace silvasim::ecosystem
