#include "silvavis/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "silvasim/base/error.h"
#include "silvasim/base/machine.h"
#include "silvasim/base/parallel.h"
#include "silvavis/scene/instance.h"
#include "silvavis/scene/tile_sites.h"

namespace silvavis::scene {

namespace {

namespace ecosystem = silvasim::ecosystem;

// A species' models go into the scene's list; the layer learns how far they reach.
void add_species(Scene& scene, PlantLayer& layer, const ecosystem::Species& species, const SpeciesModelSet& models) {
  SpeciesModels entry;
  entry.name = species.name;
  entry.first_model = static_cast<std::uint32_t>(scene.models.size());
  entry.variants = static_cast<std::uint32_t>(models.size());
  entry.model_radius_m = species.model_radius_m;
  entry.colour = species.colour;
  for (const auto& model : models) {
    entry.most_reach = std::max(entry.most_reach, model->reach_m / species.model_radius_m * 1.001f);
    entry.most_height = std::max(entry.most_height, model->most.z / species.model_radius_m);
    layer.least_height = std::min(layer.least_height, model->least.z / species.model_radius_m);
    scene.models.push_back(model);
  }
  layer.most_reach = std::max(layer.most_reach, entry.most_reach);
  layer.most_height = std::max(layer.most_height, entry.most_height);
  layer.species.push_back(std::move(entry));
}

// How far a plant reaches beyond the quarter that it stands in.
float overhang(const PlantLayer& layer) {
  float most = 0;
  for (const TileSites& tile : layer.tile_sites)
    for (std::size_t s = 0; s < tile.count; ++s) most = std::max(most, tile.reach_m[s]);
  return most;
}

// Heights and species of one tile position's plants, in its tile's slot order.
std::array<HeightRange, quarters * quarters> place_plants(const Scene& scene, PlantLayer& layer,
                                                          const ecosystem::Layer& from, int column, int row,
                                                          std::vector<double>& heights) {
  const std::size_t position = layer.position(column, row);
  const TileSites& tile = layer.tile_sites[layer.tiles[position]];
  const std::uint64_t first = layer.first_slot[position];
  const double west = layer.west + column * layer.tile_side_m, south = layer.south + row * layer.tile_side_m;
  heights.assign(tile.count, 0);
  double least = std::numeric_limits<double>::infinity(), most = -least;
  std::array<HeightRange, quarters * quarters> ranges;
  const auto quarter_of = [&](float at) {
    return std::clamp(static_cast<int>(static_cast<double>(at) / layer.tile_side_m * quarters), 0, quarters - 1);
  };
  for (std::uint32_t slot = 0; slot < tile.count; ++slot) {
    const ecosystem::PlantId id = from.plants[first + tile.site_ids[slot]];
    const bool stands = id != ecosystem::no_plant && layer.species[id].variants > 0;
    layer.plant_species[first + slot] = stands ? static_cast<std::uint8_t>(id) : no_species;
    if (!stands) continue;
    const SpeciesModels& species = layer.species[id];
    const PlantModel& model = *scene.models[species.first_model];
    const GroundPoint ground = ground_at(scene.ground, west + static_cast<double>(tile.x_m[slot]),
                                         south + static_cast<double>(tile.y_m[slot]));
    const double scale = static_cast<double>(tile.radius_m[slot] / species.model_radius_m);
    // Sunk until no part of the stem's foot hangs over the falling side.
    const double sunk = static_cast<double>(model.foot_m) * scale * std::hypot(ground.slope_x, ground.slope_y);
    heights[slot] = ground.height_m - sunk;
    least = std::min(least, heights[slot]);
    most = std::max(most, heights[slot]);
    const auto foot = static_cast<float>(heights[slot]);
    float low = 0, high = 0;
    for (std::uint32_t v = 0; v < species.variants; ++v) {
      low = std::min(low, scene.models[species.first_model + v]->least.z);
      high = std::max(high, scene.models[species.first_model + v]->most.z);
    }
    HeightRange& range =
        ranges[static_cast<std::size_t>(quarter_of(tile.y_m[slot]) * quarters + quarter_of(tile.x_m[slot]))];
    const HeightRange own{foot + low * static_cast<float>(scale), foot + high * static_cast<float>(scale)};
    range = range.least_m > range.most_m
                ? own
                : HeightRange{std::min(range.least_m, own.least_m), std::max(range.most_m, own.most_m)};
  }
  layer.base_m[position] = std::isfinite(least) ? static_cast<float>(least) : 0.0f;
  layer.step_m[position] = std::isfinite(least) ? static_cast<float>((most - least) / 65535.0) : 0.0f;
  const double step = static_cast<double>(layer.step_m[position]), base = static_cast<double>(layer.base_m[position]);
  for (std::uint32_t slot = 0; slot < tile.count; ++slot) {
    const double stored = step > 0 ? std::round((heights[slot] - base) / step) : 0;
    layer.plant_heights[first + slot] = static_cast<std::uint16_t>(std::clamp(stored, 0.0, 65535.0));
  }
  return ranges;
}

// Uses the plants of `from` up, row by row.
void place_layer(Scene& scene, PlantLayer& layer, ecosystem::Layer& from) {
  const std::size_t positions = layer.tiles.size();
  layer.base_m.resize(positions);
  layer.step_m.resize(positions);
  layer.plant_species.resize(layer.first_slot.back() + 16);
  layer.plant_heights.resize(layer.first_slot.back() + 16);
  std::fill(layer.plant_species.end() - 16, layer.plant_species.end(), no_species);
  std::fill(layer.plant_heights.end() - 16, layer.plant_heights.end(), std::uint16_t{0});

  std::vector<std::array<HeightRange, quarters * quarters>> ranges(positions);  // from the south
  std::vector<std::uint64_t> standing(static_cast<std::size_t>(layer.rows));
  silvasim::base::parallel_for(static_cast<std::size_t>(layer.rows), [&](std::size_t r) {
    std::vector<double> heights;
    const int row = static_cast<int>(r);
    for (int column = 0; column < layer.columns; ++column) {
      ranges[r * static_cast<std::size_t>(layer.columns) + static_cast<std::size_t>(column)] =
          place_plants(scene, layer, from, column, row, heights);
      const std::size_t position = layer.position(column, row);
      standing[r] += static_cast<std::uint64_t>(
          std::count_if(layer.plant_species.begin() + static_cast<std::ptrdiff_t>(layer.first_slot[position]),
                        layer.plant_species.begin() + static_cast<std::ptrdiff_t>(layer.first_slot[position + 1]),
                        [](std::uint8_t species) { return species != no_species; }));
    }
    const std::uint64_t first = layer.first_slot[layer.position(0, row)],
                        end = layer.first_slot[layer.position(layer.columns - 1, row) + 1];
    silvasim::base::give_back_pages(from.plants.data() + first, (end - first) * sizeof(ecosystem::PlantId));
  });
  for (const std::uint64_t count : standing) scene.plants += count;

  HeightRange whole{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};
  for (const auto& of_position : ranges) {
    for (const HeightRange& range : of_position) {
      if (range.least_m > range.most_m) continue;
      whole.least_m = std::min(whole.least_m, range.least_m);
      whole.most_m = std::max(whole.most_m, range.most_m);
    }
  }
  if (whole.least_m > whole.most_m) whole = {0, 0};  // no plant at all
  layer.pyramid = make_pyramid(layer.columns * quarters, layer.rows * quarters, whole, [&](int column, int row) {
    return ranges[static_cast<std::size_t>(row / quarters) * static_cast<std::size_t>(layer.columns) +
                  static_cast<std::size_t>(column / quarters)]
                 [static_cast<std::size_t>(row % quarters * quarters + column % quarters)];
  });
  layer.pyramid.west = static_cast<float>(layer.west);
  layer.pyramid.south = static_cast<float>(layer.south);
  layer.pyramid.cell_x_m = layer.pyramid.cell_y_m = static_cast<float>(layer.tile_side_m / quarters);
  layer.pyramid.margin_m = overhang(layer) + 0.01f;
}

HeightRange plant_range(const Pyramid& pyramid, int column, int row) {
  if (column < 0 || row < 0 || column >= pyramid.columns || row >= pyramid.rows) return {};
  const Pyramid::Level& level = pyramid.levels.front();
  const PyramidNode& node = level.nodes[static_cast<std::size_t>(row / 4) * static_cast<std::size_t>(level.columns) +
                                        static_cast<std::size_t>(column / 4)];
  const auto child = static_cast<std::size_t>(row % 4 * 4 + column % 4);
  if (node.least[child] > node.most[child]) return {};
  return {pyramid.origin_m + pyramid.step_m * static_cast<float>(node.least[child]),
          pyramid.origin_m + pyramid.step_m * static_cast<float>(node.most[child])};
}

// Of all vertices in the box and next to it.
HeightRange ground_range(const Ground& ground, double west, double south, double side_x, double side_y) {
  const auto index = [](double at, int count, bool up) {
    return std::clamp(static_cast<int>(up ? std::ceil(at) : std::floor(at)), 0, count - 1);
  };
  const int i0 = index((west - ground.west) / ground.cell_x_m, ground.columns, false);
  const int i1 = index((west + side_x - ground.west) / ground.cell_x_m, ground.columns, true);
  const int j0 = index((south - ground.south) / ground.cell_y_m, ground.rows, false);
  const int j1 = index((south + side_y - ground.south) / ground.cell_y_m, ground.rows, true);
  HeightRange range{ground.at(i0, j0), ground.at(i0, j0)};
  for (int j = j0; j <= j1; ++j) {
    for (int i = i0; i <= i1; ++i) {
      range.least_m = std::min(range.least_m, ground.at(i, j));
      range.most_m = std::max(range.most_m, ground.at(i, j));
    }
  }
  return range;
}

constexpr std::int64_t most_land_positions = std::int64_t{1} << 26;  // 70 bytes each

void make_land(Scene& scene) {
  const Ground& ground = scene.ground;
  const PlantLayer* const layer = scene.layers.empty() ? nullptr : &scene.layers.front();
  const double side = layer ? layer->tile_side_m : 8 * std::max(ground.cell_x_m, ground.cell_y_m);
  const double west = layer ? layer->west : ground.west, south = layer ? layer->south : ground.south;
  // Before anything is counted in whole numbers: a file may hold any terrain beside any tiles.
  const double east = west + (layer ? layer->columns * side : 0), north = south + (layer ? layer->rows * side : 0);
  const double across = (std::max(ground.east(), east) - std::min(ground.west, west)) / side,
               down = (std::max(ground.north(), north) - std::min(ground.south, south)) / side;
  if (const auto most = static_cast<double>(most_land_positions);
      !(across * down <= most && std::max(across, down) <= most / 4)) {
    throw silvasim::base::Error("the terrain is so much larger than the tiles of " +
                                (layer ? "layer \"" + layer->name + "\"" : std::string("the land")) + ", " +
                                std::to_string(side) + " m wide, that it takes " + std::to_string(across * down) +
                                " of them; pictures hold at most " + std::to_string(most_land_positions));
  }
  LandGrid& land = scene.land;
  land.first_column = std::min(0, static_cast<int>(std::floor((ground.west - west) / side)));
  land.first_row = std::min(0, static_cast<int>(std::floor((ground.south - south) / side)));
  const int columns = std::max(layer ? layer->columns : 0, static_cast<int>(std::ceil((ground.east() - west) / side))) -
                      land.first_column;
  const int rows =
      std::max(layer ? layer->rows : 0, static_cast<int>(std::ceil((ground.north() - south) / side))) - land.first_row;
  const Pyramid& below = ground.pyramid;
  HeightRange whole{below.origin_m, below.origin_m + 65535 * below.step_m};
  if (layer) {
    whole.least_m = std::min(whole.least_m, layer->pyramid.origin_m);
    whole.most_m = std::max(whole.most_m, layer->pyramid.origin_m + 65535 * layer->pyramid.step_m);
  }
  const double quarter = side / quarters;
  land.canopy.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) * quarters * quarters, 0);
  land.pyramid = make_pyramid(columns * quarters, rows * quarters, whole, [&](int i, int j) {
    const int column = i + land.first_column * quarters, row = j + land.first_row * quarters;
    const HeightRange bare = ground_range(ground, west + column * quarter, south + row * quarter, quarter, quarter);
    const HeightRange grown = layer ? plant_range(layer->pyramid, column, row) : HeightRange{};
    if (grown.least_m > grown.most_m) return bare;
    const std::size_t node = static_cast<std::size_t>(j / quarters) * static_cast<std::size_t>(columns) +
                             static_cast<std::size_t>(i / quarters);
    land.canopy[node * quarters * quarters + static_cast<std::size_t>(j % quarters * quarters + i % quarters)] =
        static_cast<std::uint8_t>(
            std::clamp(std::floor((grown.most_m - bare.most_m) / LandGrid::canopy_step_m), 0.0f, 255.0f));
    return HeightRange{std::min(bare.least_m, grown.least_m), std::max(bare.most_m, grown.most_m)};
  });
  land.pyramid.west = static_cast<float>(west + land.first_column * side);
  land.pyramid.south = static_cast<float>(south + land.first_row * side);
  land.pyramid.cell_x_m = land.pyramid.cell_y_m = static_cast<float>(quarter);
  land.pyramid.margin_m = layer ? layer->pyramid.margin_m : 0.0f;
}

}  // namespace

const std::array<Turn, 256>& turns() {
  static const std::array<Turn, 256> table = [] {
    std::array<Turn, 256> turns;
    for (std::size_t i = 0; i < turns.size(); ++i) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(i) / 256;
      turns[i] = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
    }
    return turns;
  }();
  return table;
}

std::size_t Scene::plant_bytes() const {
  std::size_t sum = land.pyramid.bytes() + land.canopy.size();
  for (const PlantLayer& layer : layers) {
    sum += layer.plant_species.size() + 2 * layer.plant_heights.size() + layer.pyramid.bytes();
    sum += layer.tiles.size() * (2 + 8 + 4 + 4);
    for (const TileSites& tile : layer.tile_sites)
      sum += tile.x_m.size() * 16 + tile.site_ids.size() * 4 + tile.nodes.size() * sizeof(SiteNode);
  }
  return sum;
}

Scene make_scene(ecosystem::Ecosystem from, const std::vector<std::vector<SpeciesModelSet>>& models) {
  Scene scene;
  scene.crs_wkt = from.crs_wkt;
  const silvasim::base::Box& extent = from.extent;
  scene.origin = {std::round(0.5 * (extent.west + extent.east)), std::round(0.5 * (extent.south + extent.north))};
  scene.extent = {extent.west - scene.origin.x, extent.south - scene.origin.y, extent.east - scene.origin.x,
                  extent.north - scene.origin.y};
  scene.ground = make_ground(from.terrain, extent, scene.origin);
  from.terrain = {};
  if (from.layers.size() > 255)
    throw silvasim::base::Error("the ecosystem has " + std::to_string(from.layers.size()) +
                                " layers; pictures hold at most 255");
  std::uint32_t first_species = 0;
  std::uint64_t first_plant = 0;
  for (std::size_t k = 0; k < from.layers.size(); ++k) {
    ecosystem::Layer& source = from.layers[k];
    if (source.species.size() > no_species) {
      throw silvasim::base::Error("layer \"" + source.name + "\" has " + std::to_string(source.species.size()) +
                                  " species; pictures hold at most 255 a layer");
    }
    PlantLayer layer;
    layer.name = source.name;
    layer.tile_side_m = source.tile_set.side_m;
    layer.columns = source.tiling.columns;
    layer.rows = source.tiling.rows;
    layer.west = source.north_west.x - scene.origin.x;
    layer.south = source.north_west.y - scene.origin.y - layer.rows * layer.tile_side_m;
    layer.first_species = first_species;
    layer.first_plant = first_plant;
    for (std::size_t s = 0; s < source.species.size(); ++s) add_species(scene, layer, source.species[s], models[k][s]);
    layer.tile_sites.resize(source.tile_set.tiles.size());
    silvasim::base::parallel_for(layer.tile_sites.size(), [&](std::size_t t) {
      layer.tile_sites[t] = make_tile_sites(source.tile_set.tiles[t], layer.most_reach);
    });
    layer.first_slot = ecosystem::site_offsets(source.tile_set, source.tiling);
    layer.tiles = std::move(source.tiling.tiles);
    place_layer(scene, layer, source);
    first_species += static_cast<std::uint32_t>(source.species.size());
    first_plant += layer.first_slot.back();
    source = {};
    scene.layers.push_back(std::move(layer));
  }
  make_land(scene);
  // The land's holds it.
  if (!scene.layers.empty()) scene.layers.front().pyramid = {};
  from = {};
  silvasim::base::give_back_free_memory();
  return scene;
}

}  // namespace silvavis::scene
