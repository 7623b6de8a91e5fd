#include "ghosttile/fill/file.h"

#include <algorithm>

#include "ghosttile/fill/select.h"
#include "silvasim/base/error.h"

namespace ghosttile::fill {

namespace {

using tile::ByteReader;
using tile::ByteWriter;
using tile::NamedChunk;

constexpr tile::ChunkType placed_type{'D', 'P', 'L', 'C'};
constexpr tile::ChunkType edits_type{'D', 'E', 'D', 'T'};

void put_box(ByteWriter& to, const TileBox& box) {
  for (const int v : {box.x0, box.y0, box.z0, box.x1, box.y1, box.z1}) to.put(static_cast<std::int32_t>(v));
}
TileBox get_box(ByteReader& from) {
  TileBox box;
  for (int* v : {&box.x0, &box.y0, &box.z0, &box.x1, &box.y1, &box.z1}) {
    *v = from.get<std::int32_t>();
    if (*v < -2 * farthest_tile || *v > 2 * farthest_tile) from.fail("a box reaches too far");
  }
  return box;
}

// Column by column: places compress well beside each other.
void put_details(ByteWriter& to, const Details& details) {
  to.put(static_cast<std::uint32_t>(details.tiles.size()));
  for (const TilePlace& place : details.tiles) to.put(place.x);
  for (const TilePlace& place : details.tiles) to.put(place.y);
  for (const TilePlace& place : details.tiles) to.put(place.z);
  for (std::size_t t = 0; t < details.tiles.size(); ++t)
    to.put(static_cast<std::uint16_t>(details.first[t + 1] - details.first[t]));
  for (const std::uint16_t n : details.instances) to.put(n);
  to.put(static_cast<std::uint32_t>(details.chosen.size()));
  for (const std::uint16_t c : details.chosen) to.put(c);
}

Details get_details(ByteReader& from, std::uint32_t candidates) {
  Details details;
  const std::uint32_t tiles = from.get_count(16);
  details.tiles.resize(tiles);
  for (TilePlace& place : details.tiles) place.x = from.get<std::int32_t>();
  for (TilePlace& place : details.tiles) place.y = from.get<std::int32_t>();
  for (TilePlace& place : details.tiles) place.z = from.get<std::int32_t>();
  for (std::size_t t = 0; t < tiles; ++t) {
    const auto far = [](std::int32_t v) { return v < -farthest_tile || v > farthest_tile; };
    if (far(details.tiles[t].x) || far(details.tiles[t].y) || far(details.tiles[t].z))
      from.fail("a tile lies too far away");
    if (t > 0 && !(details.tiles[t - 1] < details.tiles[t])) from.fail("its tiles are out of order");
  }
  details.first.push_back(0);
  std::uint64_t sum = 0;
  for (std::size_t t = 0; t < tiles; ++t) {
    sum += from.get<std::uint16_t>();
    if (sum > 0xFFFFFFFFu) from.fail("its tiles hold too many candidates");
    details.first.push_back(static_cast<std::uint32_t>(sum));
  }
  for (std::size_t t = 0; t < tiles; ++t) {
    details.instances.push_back(from.get<std::uint16_t>());
    if (details.instances.back() > details.first[t + 1] - details.first[t])
      from.fail("a tile has more instances than places");
  }
  details.chosen.resize(from.get_count(2));
  if (details.chosen.size() != details.first.back())
    from.fail("its tiles hold another number of candidates than there are");
  for (std::uint16_t& c : details.chosen) {
    c = from.get<std::uint16_t>();
    if (c >= candidates) from.fail("a candidate is none of the Ghost Tile's");
  }
  for (std::size_t t = 0; t < tiles; ++t) {
    const std::uint32_t middle = details.first[t] + details.instances[t];
    for (std::uint32_t c = details.first[t] + 1; c < details.first[t + 1]; ++c)
      if (c != middle && details.chosen[c] <= details.chosen[c - 1]) from.fail("a tile's candidates are out of order");
    for (const std::uint16_t refused : details.refused_of(t))
      if (std::ranges::binary_search(details.of(t), refused)) from.fail("a candidate stands and is refused at once");
  }
  return details;
}

// Numbering tiles takes memory by how far they lie apart: no file may ask for much more than its own size.
std::string problem_with(const std::vector<TilePlace>& tiles) {
  if (tiles.empty()) return {};
  int west = tiles[0].x, east = tiles[0].x;
  std::uint64_t between = 0;
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    west = std::min(west, tiles[t].x);
    east = std::max(east, tiles[t].x);
    if (t > 0 && tiles[t].x == tiles[t - 1].x && tiles[t].y == tiles[t - 1].y)
      between += static_cast<std::uint64_t>(tiles[t].z - tiles[t - 1].z);
  }
  const double columns =
      (static_cast<double>(east) - west + 16) / 16 * ((static_cast<double>(tiles.back().y) - tiles[0].y + 16) / 16);
  if (columns > 0x1p25 + 16.0 * static_cast<double>(tiles.size())) return "its tiles lie too far apart";
  if (between > 1'000'000 + 16 * tiles.size()) return "its tiles lie too high above each other";
  return {};
}

// Whether any two of what stands collide: each takes away what it collides with, and must still be there itself.
bool collides(const tile::CollisionGraph& graph, const Details& details) {
  const TileIndex index(details.tiles);
  const std::uint32_t words = graph.words_a_tile();
  std::vector<std::uint64_t> left(std::size_t{index.size()} * words, ~std::uint64_t{0});
  for (std::size_t t = 0; t < details.tiles.size(); ++t)
    for (std::uint32_t c = details.first[t]; c < details.first[t + 1]; ++c)
      bar(graph, details.tiles[t], details.chosen[c], index, words, left.data());
  for (std::size_t t = 0; t < details.tiles.size(); ++t) {
    const TilePlace& place = details.tiles[t];
    const std::size_t base = std::size_t{index.slot(place.x, place.y, place.z)} * words;
    for (std::uint32_t c = details.first[t]; c < details.first[t + 1]; ++c)
      if (!(left[base + details.chosen[c] / 64] >> details.chosen[c] % 64 & 1)) return true;
  }
  return false;
}

}  // namespace

std::vector<std::byte> to_bytes(const DetailsFile& file) {
  std::vector<NamedChunk> chunks;
  const auto add = [&](const tile::ChunkType& type, const auto& put) {
    ByteWriter to;
    put(to);
    chunks.push_back({type, to.take()});
  };
  add(details_type, [&](ByteWriter& to) {
    to.put(std::uint32_t{1});
    to.put_text(file.scene);
    to.put_text(file.scene_sha256);
    to.put_text(file.crs_wkt);
    put_box(to, file.filled);
  });
  for (NamedChunk& chunk : tile::chunks_of(*file.tile)) chunks.push_back(std::move(chunk));
  add(placed_type, [&](ByteWriter& to) { put_details(to, file.details); });
  add(edits_type, [&](ByteWriter& to) {
    to.put(static_cast<std::uint32_t>(file.edits.size()));
    for (const Edit& edit : file.edits) {
      to.put_text(edit.strokes_xml);
      put_box(to, edit.touched);
      put_details(to, edit.before);
    }
  });
  return tile::file_bytes(std::move(chunks));
}

namespace {

DetailsFile file_from(const std::vector<NamedChunk>& chunks, const std::string& name) {
  DetailsFile file;
  ByteReader meta = tile::reader_of(chunks, details_type, name);
  if (const auto version = meta.get<std::uint32_t>(); version != 1)
    meta.fail("it is of version " + std::to_string(version) + "; this program reads version 1");
  file.scene = meta.get_text();
  file.scene_sha256 = meta.get_text();
  file.crs_wkt = meta.get_text();
  file.filled = get_box(meta);
  meta.expect_end();
  file.tile = std::make_shared<tile::GhostTile>(tile::tile_from(chunks, name));
  const auto candidates = static_cast<std::uint32_t>(file.tile->candidates.size());
  ByteReader placed = tile::reader_of(chunks, placed_type, name);
  file.details = get_details(placed, candidates);
  placed.expect_end();
  if (const std::string problem = problem_with(file.details.tiles); !problem.empty()) placed.fail(problem);
  if (collides(file.tile->graph, file.details)) placed.fail("two of its instances collide");
  ByteReader edits = tile::reader_of(chunks, edits_type, name);
  const std::uint32_t count = edits.get_count(36);
  if (count > most_edits) edits.fail("it has more than " + std::to_string(most_edits) + " edits");
  for (std::uint32_t e = 0; e < count; ++e) {
    Edit edit;
    edit.strokes_xml = edits.get_text();
    edit.touched = get_box(edits);
    edit.before = get_details(edits, candidates);
    for (const TilePlace& place : edit.before.tiles)
      if (!edit.touched.holds(place.x, place.y, place.z)) edits.fail("an edit holds a tile that it did not touch");
    file.edits.push_back(std::move(edit));
  }
  edits.expect_end();
  return file;
}

}  // namespace

DetailsFile from_bytes(std::span<const std::byte> bytes, const std::string& name) {
  return file_from(tile::chunks_from(bytes, name, details_type, "file of details"), name);
}

void write(const DetailsFile& file, const std::filesystem::path& path, std::span<const std::filesystem::path> inputs) {
  tile::write_bytes(to_bytes(file), path, inputs);
}

DetailsFile read(const std::filesystem::path& path) {
  return file_from(tile::read_chunks(path, details_type, "file of details"), path.string());
}

}  // namespace ghosttile::fill
