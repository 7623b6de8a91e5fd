#include "ghosttile/tile/file.h"

#include <cmath>

#include "ghosttile/objects/anchors.h"
#include "ghosttile/tile/create.h"
#include "ghosttile/tile/model_bytes.h"

namespace ghosttile::tile {

namespace {

constexpr ChunkType objects_type{'G', 'O', 'B', 'J'};
constexpr ChunkType candidates_type{'G', 'C', 'N', 'D'};
constexpr ChunkType graph_type{'G', 'G', 'R', 'F'};

void put_spheres(ByteWriter& to, const objects::Detail& object) {
  to.put(static_cast<std::uint32_t>(object.spheres.size()));
  for (const objects::Sphere& sphere : object.spheres) {
    put_vector(to, sphere.centre);
    to.put(sphere.radius_m);
  }
  to.put(object.error.outside_m);
  to.put(object.error.uncovered_m);
  to.put(object.error.mean_m);
  to.put(static_cast<std::uint32_t>(object.anchors.size()));
  for (const V3& anchor : object.anchors) put_vector(to, anchor);
}

void get_spheres(ByteReader& from, objects::Detail& object) {
  object.spheres.resize(from.get_count(16));
  for (objects::Sphere& sphere : object.spheres) {
    sphere.centre = get_vector(from);
    sphere.radius_m = from.get<float>();
    if (!(sphere.radius_m > 0 && sphere.radius_m < 1e6f)) from.fail("a sphere has no radius");
  }
  object.error = {from.get<float>(), from.get<float>(), from.get<float>()};
  object.anchors.resize(from.get_count(12));
  if (object.anchors.size() > objects::most_anchors)
    from.fail("an object has more than " + std::to_string(objects::most_anchors) + " anchors");
  for (V3& anchor : object.anchors) anchor = get_vector(from);
  if (object.spheres.empty() || object.anchors.empty()) from.fail("an object has no sphere or no anchor");
}

void put_candidates(ByteWriter& to, const GhostTile& tile) {
  to.put(static_cast<std::uint32_t>(tile.candidates.size()));
  for (const Candidate& candidate : tile.candidates) {
    to.put(candidate.object);
    to.put(candidate.scale);
    put_vector(to, candidate.at);
    to.put(candidate.rotation.w);
    to.put(candidate.rotation.x);
    to.put(candidate.rotation.y);
    to.put(candidate.rotation.z);
  }
}

void get_candidates(ByteReader& from, GhostTile& tile) {
  const std::uint32_t count = from.get_count(34);
  if (count == 0 || count > 65535) from.fail("a tile has 1 to 65535 candidates, not " + std::to_string(count));
  tile.candidates.resize(count);
  for (Candidate& candidate : tile.candidates) {
    candidate.object = from.get<std::uint16_t>();
    candidate.scale = from.get<float>();
    candidate.at = get_vector(from);
    Rotation& r = candidate.rotation;
    r = {from.get<float>(), from.get<float>(), from.get<float>(), from.get<float>()};
    if (candidate.object >= tile.objects.size()) from.fail("a candidate is of an object that is none");
    if (!(candidate.scale > 0 && candidate.scale < 1e6f)) from.fail("a candidate has no scale");
    if (!(std::abs(r.w * r.w + r.x * r.x + r.y * r.y + r.z * r.z - 1) < 1e-3f))
      from.fail("a candidate's frame is no rotation");
    for (int axis = 0; axis < 3; ++axis)
      if (!(candidate.at[axis] >= 0 && candidate.at[axis] <= tile.side_m))
        from.fail("a candidate lies outside of the tile");
  }
  from.expect_end();
}

void put_graph(ByteWriter& to, const CollisionGraph& graph) {
  to.put(static_cast<std::uint32_t>(graph.reach));
  put_column(to, graph.first_word);
  put_column(to, graph.places);
  put_column(to, graph.bits);
}

CollisionGraph get_graph(ByteReader& from, std::uint32_t candidates) {
  CollisionGraph graph;
  graph.candidates = candidates;
  const std::uint32_t reach = from.get<std::uint32_t>();
  if (reach < 1 || reach > static_cast<std::uint32_t>(most_reach))
    from.fail("its offsets reach 1 to " + std::to_string(most_reach) + " tiles, not " + std::to_string(reach));
  graph.reach = static_cast<int>(reach);
  graph.first_word = get_column<std::uint32_t>(from);
  graph.places = get_column<std::uint16_t>(from);
  graph.bits = get_column<std::uint64_t>(from);
  if (const std::string problem = graph.problem(); !problem.empty()) from.fail(problem);
  from.expect_end();
  return graph;
}

}  // namespace

std::vector<NamedChunk> chunks_of(const GhostTile& tile) {
  std::vector<NamedChunk> chunks;
  const auto add = [&](const ChunkType& type, const auto& put) {
    ByteWriter to;
    put(to);
    chunks.push_back({type, to.take()});
  };
  add(tile_type, [&](ByteWriter& to) {
    to.put(std::uint32_t{1});
    to.put(tile.side_m);
    to.put(tile.delta_m);
    to.put(tile.seed);
  });
  add(objects_type, [&](ByteWriter& to) {
    to.put(static_cast<std::uint32_t>(tile.objects.size()));
    for (const objects::Detail& object : tile.objects) {
      to.put_text(object.name);
      put_spheres(to, object);
      put_model(to, object.model);
    }
  });
  add(candidates_type, [&](ByteWriter& to) { put_candidates(to, tile); });
  add(graph_type, [&](ByteWriter& to) { put_graph(to, tile.graph); });
  return chunks;
}

GhostTile tile_from(const std::vector<NamedChunk>& chunks, const std::string& name) {
  GhostTile tile;
  ByteReader meta = reader_of(chunks, tile_type, name);
  if (const auto version = meta.get<std::uint32_t>(); version != 1)
    meta.fail("it is of version " + std::to_string(version) + "; this program reads version 1");
  tile.side_m = meta.get<float>();
  tile.delta_m = meta.get<float>();
  tile.seed = meta.get<std::uint64_t>();
  meta.expect_end();
  if (!(tile.side_m > 1e-6f && tile.side_m < 1e6f && std::abs(tile.delta_m) < 1e6f))
    meta.fail("its side or its threshold is no length");
  ByteReader objects = reader_of(chunks, objects_type, name);
  const std::uint32_t count = objects.get_count(40);
  if (count == 0 || count > 65535) objects.fail("a tile has 1 to 65535 objects, not " + std::to_string(count));
  for (std::uint32_t o = 0; o < count; ++o) {
    objects::Detail object;
    object.name = objects.get_text();
    get_spheres(objects, object);
    object.model = get_model(objects);
    tile.objects.push_back(std::move(object));
  }
  objects.expect_end();
  ByteReader candidates = reader_of(chunks, candidates_type, name);
  get_candidates(candidates, tile);
  ByteReader graph = reader_of(chunks, graph_type, name);
  tile.graph = get_graph(graph, static_cast<std::uint32_t>(tile.candidates.size()));
  return tile;
}

void write(const GhostTile& tile, const std::filesystem::path& path, std::span<const std::filesystem::path> inputs) {
  write_bytes(file_bytes(chunks_of(tile)), path, inputs);
}

GhostTile read(const std::filesystem::path& path) {
  return tile_from(read_chunks(path, tile_type, "Ghost Tile"), path.string());
}

}  // namespace ghosttile::tile
