#include "ghosttile/commands/console.h"

#include <fmt/format.h>

#include <cstdio>

#include "silvasim/base/words.h"

namespace ghosttile::commands {

using silvasim::base::shortened;
using silvasim::terminal::bytes_text;
using silvasim::terminal::grouped;

Json tile_json(const tile::GhostTile& tile) {
  Json json;
  json["side_m"] = tile.side_m;
  json["delta_m"] = tile.delta_m;
  json["seed"] = tile.seed;
  std::vector<std::uint64_t> candidates(tile.objects.size(), 0);
  for (const tile::Candidate& candidate : tile.candidates) ++candidates[candidate.object];
  json["objects"] = Json::array();
  for (std::size_t o = 0; o < tile.objects.size(); ++o) {
    const objects::Detail& object = tile.objects[o];
    json["objects"].push_back({{"name", object.name},
                               {"candidates", candidates[o]},
                               {"triangles", object.model.triangles.size()},
                               {"spheres", object.spheres.size()},
                               {"spheres_outside_m", object.error.outside_m},
                               {"surface_uncovered_m", object.error.uncovered_m},
                               {"anchors", object.anchors.size()}});
  }
  json["candidates"] = tile.candidates.size();
  const std::uint64_t pairs = tile.graph.arcs() / 2;
  json["colliding_pairs"] = pairs;
  json["collisions_a_candidate"] = static_cast<double>(pairs) / static_cast<double>(tile.candidates.size());
  json["offsets_reach_tiles"] = tile.graph.reach;
  json["graph_bytes"] = tile.graph.bytes();
  return json;
}

void print_tile(const tile::GhostTile& tile) {
  const Json json = tile_json(tile);
  fmt::print("Ghost Tile of {:g} m, threshold {:g} mm: {} candidates, {} colliding pairs, graph of {}\n",
             static_cast<double>(tile.side_m), static_cast<double>(tile.delta_m) * 1000,
             grouped(tile.candidates.size()), grouped(tile.graph.arcs() / 2), bytes_text(tile.graph.bytes()));
  for (const auto& object : json["objects"]) {
    fmt::print(
        "  {:<24} {:>6} candidates, {:>4} triangles, {:>3} spheres (reach {:.1f} mm out, leave {:.1f} mm uncovered), "
        "{} anchor{}\n",
        shortened(object["name"].get<std::string>(), 24), object["candidates"].get<std::uint64_t>(),
        object["triangles"].get<std::uint64_t>(), object["spheres"].get<std::uint64_t>(),
        object["spheres_outside_m"].get<double>() * 1000, object["surface_uncovered_m"].get<double>() * 1000,
        object["anchors"].get<std::uint64_t>(), object["anchors"].get<std::uint64_t>() == 1 ? "" : "s");
  }
}

std::vector<std::uint64_t> instances_by_object(const tile::GhostTile& tile, const fill::Details& details) {
  std::vector<std::uint64_t> sums(tile.objects.size(), 0);
  for (std::size_t t = 0; t < details.tiles.size(); ++t)
    for (const std::uint16_t candidate : details.of(t)) ++sums[tile.candidates[candidate].object];
  return sums;
}

Json details_json(const tile::GhostTile& tile, const fill::Details& details) {
  Json json;
  json["instances"] = details.count();
  json["refused"] = details.chosen.size() - details.count();
  json["tiles"] = details.tiles.size();
  json["bytes"] = details.bytes();
  const std::vector<std::uint64_t> sums = instances_by_object(tile, details);
  json["objects"] = Json::array();
  for (std::size_t o = 0; o < tile.objects.size(); ++o)
    json["objects"].push_back({{"name", tile.objects[o].name}, {"instances", sums[o]}});
  return json;
}

void print_details(const tile::GhostTile& tile, const fill::Details& details) {
  fmt::print("{} instances in {} tiles, {}\n", grouped(details.count()), grouped(details.tiles.size()),
             bytes_text(details.bytes()));
  const std::vector<std::uint64_t> sums = instances_by_object(tile, details);
  for (std::size_t o = 0; o < tile.objects.size(); ++o)
    fmt::print("  {:<24} {:>12}\n", shortened(tile.objects[o].name, 24), grouped(sums[o]));
}

void print_warnings(const std::vector<std::string>& warnings, const silvasim::terminal::Common& common) {
  if (common.quiet) return;
  for (const std::string& warning : warnings) fmt::print(stderr, "warning: {}\n", warning);
}

}  // namespace ghosttile::commands
