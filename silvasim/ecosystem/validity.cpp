#include "silvasim/ecosystem/validity.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

namespace silvasim::ecosystem {

namespace {

constexpr std::size_t most_tiles = 65536;  // indices in a tiling have 16 bits

std::string quoted(const std::string& text) { return "\"" + text + "\""; }

bool is_text(const std::string& text) {
  if (text.find('\0') != std::string::npos) return false;
  try {
    // The JSON library refuses to write what is no UTF-8.
    return !nlohmann::json(text).dump().empty();
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

// Far more than the earth's girth; sums and products of such numbers stay exact to a millimetre, or at least finite.
constexpr double farthest_m = 1e9;

template <typename... Numbers>
bool near(Numbers... numbers) {
  return ((std::fabs(numbers) <= farthest_m) && ...);
}

// How deep objects and arrays are nested in valid JSON.
int depth_of(const std::string& json) {
  int depth = 0, deepest = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_text && c == '\\') {
      ++i;
    } else if (c == '"') {
      in_text = !in_text;
    } else if (!in_text && (c == '{' || c == '[')) {
      deepest = std::max(deepest, ++depth);
    } else if (!in_text && (c == '}' || c == ']')) {
      --depth;
    }
  }
  return deepest;
}

template <typename... Numbers>
bool finite(Numbers... numbers) {
  return (std::isfinite(numbers) && ...);
}

std::string problem_with(const tiles::Tile& tile, const tiles::TileSet& set) {
  for (std::size_t i = 0; i < tile.sites.size(); ++i) {
    const tiles::Site& site = tile.sites[i];
    const double x = static_cast<double>(site.x_m), y = static_cast<double>(site.y_m);
    const std::string name = "site " + std::to_string(i);
    if (!(x >= 0 && x < set.side_m && y >= 0 && y < set.side_m)) {
      return name + " lies at (" + std::to_string(x) + ", " + std::to_string(y) + "), outside the tile";
    }
    const double radius = static_cast<double>(site.radius_m);
    if (!(radius > 0 && radius <= set.most_radius_m)) {
      return name + " has the radius " + std::to_string(radius) + "; above 0 and at most " +
             std::to_string(set.most_radius_m) + " is allowed";
    }
  }
  return {};
}

// The index of the first value that is wrong, or the size. Counts before it searches: counting needs no branch.
template <typename Value, typename Wrong>
std::size_t first_wrong(const std::vector<Value>& values, Wrong wrong) {
  std::size_t count = 0;
  for (const Value value : values) count += wrong(value) ? 1 : 0;
  if (count == 0) return values.size();
  return static_cast<std::size_t>(std::find_if(values.begin(), values.end(), wrong) - values.begin());
}

}  // namespace

std::string problem_with_frame(const Ecosystem& ecosystem) {
  const base::Box& box = ecosystem.extent;
  if (!is_text(ecosystem.name)) return "the ecosystem's name is not UTF-8 text";
  if (!is_text(ecosystem.crs_wkt)) return "the CRS is not UTF-8 text";
  if (!finite(box.west, box.south, box.east, box.north) || box.empty()) return "the extent is empty or not finite";
  if (!near(box.west, box.south, box.east, box.north)) {
    return "the extent reaches farther than 1,000,000 km from the origin of its coordinates";
  }
  return {};
}

std::string problem_with_provenance(const std::string& json) {
  const std::size_t first = json.find_first_not_of(" \t\r\n");
  if (first == std::string::npos || json[first] != '{' || !nlohmann::json::accept(json)) {
    return "the provenance is not one JSON object";
  }
  constexpr int deepest = 64;
  if (depth_of(json) > deepest) return "the provenance is nested deeper than " + std::to_string(deepest) + " levels";
  return {};
}

std::string problem_with_grid(const Terrain& terrain) {
  const bool none = terrain.columns == 0 && terrain.rows == 0;
  if (!none && (terrain.columns <= 0 || terrain.rows <= 0)) {
    return "a terrain of " + std::to_string(terrain.columns) + " x " + std::to_string(terrain.rows) +
           " cells is not possible";
  }
  if (!finite(terrain.west, terrain.north, terrain.cell_width_m, terrain.cell_height_m) ||
      !(terrain.cell_width_m > 0 && terrain.cell_height_m > 0)) {
    return "the terrain's corner and cell size must be finite, and the cells larger than 0";
  }
  if (!near(terrain.west, terrain.north, terrain.cell_width_m, terrain.cell_height_m)) {
    return "the terrain lies farther than 1,000,000 km from the origin of its coordinates, or has larger cells";
  }
  return {};
}

std::string problem_with_heights(const std::vector<float>& heights_m) {
  const std::size_t at = first_wrong(heights_m, [](float height) { return std::isinf(height); });
  return at == heights_m.size() ? std::string{} : "height number " + std::to_string(at) + " is infinite";
}

std::string problem_with_head(const Layer& layer) {
  if (!is_text(layer.name)) return "a layer's name is not UTF-8 text";
  if (!finite(layer.north_west.x, layer.north_west.y)) {
    return "the north-west corner of layer " + quoted(layer.name) + " is not finite";
  }
  if (!near(layer.north_west.x, layer.north_west.y)) {
    return "layer " + quoted(layer.name) + " begins farther than 1,000,000 km from the origin of its coordinates";
  }
  return {};
}

std::string problem_with(const std::vector<Species>& species) {
  if (species.size() >= no_plant) {
    return "a layer may have " + std::to_string(no_plant - 1) + " species at most, not " +
           std::to_string(species.size());
  }
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < species.size(); ++i) {
    const Species& s = species[i];
    const std::string number = "species number " + std::to_string(i);
    if (!is_text(s.name) || !is_text(s.common_name) || !is_text(s.model))
      return "a text of " + number + " is not UTF-8";
    if (!names.insert(s.name).second) return "two species are named " + quoted(s.name);
    if (s.colour > 0xFFFFFF) return number + " has a colour of more than 24 bits";
    if (!finite(s.model_radius_m, s.height_m, s.least_scale, s.most_scale) || !(s.model_radius_m > 0) ||
        !(s.height_m >= 0)) {
      return number + " needs a finite model radius above 0, height and scales";
    }
    if (!(s.least_scale >= 0 && s.least_scale <= s.most_scale)) return number + " has a reversed scale range";
  }
  return {};
}

std::string problem_with(const tiles::TileSet& set) {
  if (!finite(set.side_m, set.most_radius_m) || !(set.side_m > 0) || !(set.most_radius_m > 0)) {
    return "the tiles' side and largest radius must be finite and above 0";
  }
  if (set.colours < 1 || set.colours > 256 || set.variants < 1 || static_cast<std::size_t>(set.variants) > most_tiles) {
    return std::to_string(set.colours) + " colours and " + std::to_string(set.variants) + " variants are not possible";
  }
  const auto colours = static_cast<std::size_t>(set.colours), variants = static_cast<std::size_t>(set.variants);
  if (set.tiles.size() != colours * colours * variants || set.tiles.size() > most_tiles) {
    return std::to_string(set.tiles.size()) + " tiles are not colours x colours x variants, or more than " +
           std::to_string(most_tiles);
  }
  for (std::size_t t = 0; t < set.tiles.size(); ++t) {
    const tiles::EdgeColours& edge = set.tiles[t].colours;
    const std::string number = "tile " + std::to_string(t);
    if (std::max({edge.north, edge.east, edge.south, edge.west}) >= set.colours) {
      return number + " has an edge of a colour past " + std::to_string(set.colours - 1);
    }
    if (edge.north != t / variants / colours || edge.west != t / variants % colours) {
      return number + " is out of order: tiles are sorted by northern, then western colour";
    }
    if (std::string problem = problem_with(set.tiles[t], set); !problem.empty()) return number + ": " + problem;
  }
  return {};
}

std::string problem_with(const tiles::Tiling& tiling, const tiles::TileSet& set) {
  if (tiling.columns < 1 || tiling.rows < 1) {
    return "a tiling of " + std::to_string(tiling.columns) + " x " + std::to_string(tiling.rows) +
           " tiles is not possible";
  }
  const auto columns = static_cast<std::size_t>(tiling.columns), rows = static_cast<std::size_t>(tiling.rows);
  if (tiling.tiles.size() / columns != rows || tiling.tiles.size() % columns != 0) {
    return "the tiling holds " + std::to_string(tiling.tiles.size()) + " tiles for " + std::to_string(columns) + " x " +
           std::to_string(rows);
  }
  for (std::size_t i = 0; i < tiling.tiles.size(); ++i) {
    const auto here = [&] {
      return "column " + std::to_string(i % columns) + ", row " + std::to_string(i / columns) + " of the tiling";
    };
    if (tiling.tiles[i] >= set.tiles.size()) {
      return here() + " holds tile " + std::to_string(tiling.tiles[i]) + " of " + std::to_string(set.tiles.size());
    }
    const tiles::EdgeColours& edge = set.tiles[tiling.tiles[i]].colours;
    if (i % columns != 0 && edge.west != set.tiles[tiling.tiles[i - 1]].colours.east) {
      return here() + " does not fit its western neighbour: the colours of the edge differ";
    }
    if (i >= columns && edge.north != set.tiles[tiling.tiles[i - columns]].colours.south) {
      return here() + " does not fit its northern neighbour: the colours of the edge differ";
    }
  }
  return {};
}

std::string problem_with(const SuitabilityMap& map, std::size_t species) {
  if (map.columns == 0 && map.rows == 0 && map.empty()) return {};
  if (map.columns <= 0 || map.rows <= 0 || !finite(map.west, map.north, map.cell_m) || !(map.cell_m > 0) ||
      !near(map.west, map.north, map.cell_m)) {
    return "the suitability map's size, corner and cells must be finite, and its sides and cells larger than 0";
  }
  // columns * rows < 2^62, species < 2^16.
  const auto cells = static_cast<std::uint64_t>(map.columns) * static_cast<std::uint64_t>(map.rows);
  if (species == 0 || map.shares.size() % species != 0 || map.shares.size() / species != cells) {
    return "the suitability map holds " + std::to_string(map.shares.size()) + " shares for " + std::to_string(species) +
           " species on " + std::to_string(map.columns) + " x " + std::to_string(map.rows) + " cells";
  }
  return {};
}

std::string problem_with(const Ecosystem& ecosystem) {
  if (std::string problem = problem_with_frame(ecosystem); !problem.empty()) return problem;
  if (std::string problem = problem_with_provenance(ecosystem.provenance_json); !problem.empty()) return problem;
  const Terrain& terrain = ecosystem.terrain;
  if (std::string problem = problem_with_grid(terrain); !problem.empty()) return problem;
  const std::size_t cells = static_cast<std::size_t>(terrain.columns) * static_cast<std::size_t>(terrain.rows);
  if (terrain.heights_m.size() != cells) {
    return "the terrain has " + std::to_string(terrain.heights_m.size()) + " heights for " + std::to_string(cells) +
           " cells";
  }
  if (std::string problem = problem_with_heights(terrain.heights_m); !problem.empty()) return problem;

  if (ecosystem.layers.empty()) return "it has no vegetation layer";
  std::set<std::string_view> names;
  for (const Layer& layer : ecosystem.layers) {
    const std::string name = "layer " + quoted(layer.name) + ": ";
    if (std::string problem = problem_with_head(layer); !problem.empty()) return problem;
    if (!names.insert(layer.name).second) return "two layers are named " + quoted(layer.name);
    for (const std::string& problem : {problem_with(layer.species), problem_with(layer.tile_set)}) {
      if (!problem.empty()) return name + problem;
    }
    if (std::string problem = problem_with(layer.tiling, layer.tile_set); !problem.empty()) return name + problem;
    const std::uint64_t sites = site_offsets(layer.tile_set, layer.tiling).back();
    if (layer.plants.size() != sites) {
      return name + "it has " + std::to_string(layer.plants.size()) + " plant ids for " + std::to_string(sites) +
             " sites";
    }
    if (!layer.probabilities.empty() && layer.probabilities.size() != sites) {
      return name + "it has " + std::to_string(layer.probabilities.size()) + " probabilities for " +
             std::to_string(sites) + " sites";
    }
    if (std::string problem = problem_with(layer.suitability, layer.species.size()); !problem.empty()) {
      return name + problem;
    }
    const std::size_t at =
        first_wrong(layer.plants, [count = layer.species.size()](PlantId id) { return id >= count && id != no_plant; });
    if (at != layer.plants.size()) {
      return name + "site number " + std::to_string(at) + " holds species " + std::to_string(layer.plants[at]) +
             " of " + std::to_string(layer.species.size());
    }
  }
  return {};
}

}  // namespace silvasim::ecosystem
