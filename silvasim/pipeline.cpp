#include "silvasim/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "silvasim/base/machine.h"
#include "silvasim/evaluators/network.h"
#include "silvasim/evaluators/suitability_map.h"
#include "silvasim/provenance.h"
#include "silvasim/tiles/fill.h"
#include "silvasim/tiles/tile_land.h"

namespace silvasim {

namespace {

// Adds the time from its making to its end to a stage.
class Stopwatch {
 public:
  Stopwatch(std::vector<std::pair<std::string, double>>& seconds, const char* stage)
      : seconds_(seconds), stage_(stage) {}
  ~Stopwatch() {
    const double passed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    for (auto& [stage, sum] : seconds_) {
      if (stage == stage_) {
        sum += passed;
        return;
      }
    }
    seconds_.emplace_back(stage_, passed);
  }

 private:
  std::vector<std::pair<std::string, double>>& seconds_;
  const char* stage_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// How many tiles cover a length; a last sliver below a millimetre is rounding, not land.
int tiles_across(double length_m, double side_m, const config::LayerSettings& layer) {
  constexpr double most = 1 << 16;
  const double count = std::max(1.0, std::ceil(length_m / side_m - 0.001 / side_m));
  if (count > most) {
    throw base::ConfigError(layer.tiles.place, "the scene is more than " + std::to_string(static_cast<int>(most)) +
                                                   " tiles across; enlarge <tiles side> or lessen the scene");
  }
  return static_cast<int>(count);
}

// What a layer of so many tiles will hold at once: better said before than after minutes of work.
void check_memory(const tiles::TileSet& set, int columns, int rows, const config::LayerSettings& layer) {
  double sites_a_tile = 0;
  for (const tiles::Tile& tile : set.tiles) {
    sites_a_tile += static_cast<double>(tile.sites.size()) / static_cast<double>(set.tiles.size());
  }
  const double positions = static_cast<double>(columns) * rows, sites = positions * sites_a_tile;
  constexpr double bytes_a_position = 16, bytes_a_site = 12;
  const double bytes =
      positions * bytes_a_position + sites * (bytes_a_site + 4 * static_cast<double>(layer.species.size()));
  const auto memory = static_cast<double>(base::memory_bytes());
  if (memory == 0 || bytes < memory) return;
  throw base::ConfigError(
      layer.tiles.place,
      fmt::format(
          "{} x {} tiles of {:g} m with about {:.3g} sites would take {:.0f} GB of memory, more than this machine "
          "has; enlarge the tiles or their radii, or run the scene in parts",
          columns, rows, set.side_m, sites, std::ceil(bytes / 1e9)));
}

std::vector<std::pair<std::string, double>> without_data(const evaluators::Network& network,
                                                         const evaluators::Suitability& suitability,
                                                         const fields::FieldSet& fields) {
  std::vector<std::pair<std::string, double>> shares;
  for (std::size_t k = 0; k < suitability.no_data.size(); ++k) {
    const fields::Field& field = fields.fields[static_cast<std::size_t>(network.fields()[k])];
    if (suitability.no_data[k] == 0 || field.no_data == config::NoDataPolicy::fill) continue;
    shares.emplace_back(field.name,
                        static_cast<double>(suitability.no_data[k]) / static_cast<double>(suitability.inside));
  }
  return shares;
}

std::vector<std::uint64_t> count_plants(const std::vector<ecosystem::PlantId>& plants, std::size_t species) {
  std::vector<std::uint64_t> counts(species, 0);
  for (const ecosystem::PlantId plant : plants) {
    if (plant != ecosystem::no_plant) ++counts[plant];
  }
  return counts;
}

std::vector<ecosystem::Species> species_table(const config::LayerSettings& layer) {
  std::vector<ecosystem::Species> table;
  for (const config::SpeciesSettings& species : layer.species) {
    table.push_back({species.name, species.common_name, species.colour, species.model,
                     static_cast<float>(species.model_radius_m), static_cast<float>(species.height_m),
                     static_cast<float>(species.least_scale), static_cast<float>(species.most_scale)});
  }
  return table;
}

ecosystem::Terrain terrain_of(const fields::FieldSet& fields) {
  if (fields.terrain < 0) return {};
  const fields::Raster& raster = fields.fields[static_cast<std::size_t>(fields.terrain)].raster;
  return {raster.columns, raster.rows, raster.west, raster.north, raster.cell_width, raster.cell_height, raster.values};
}

ecosystem::Layer finished(GrownLayer grown, const config::LayerSettings& settings, bool probabilities) {
  ecosystem::Layer layer;
  layer.name = settings.name;
  layer.species = species_table(settings);
  if (probabilities) {
    layer.probabilities.resize(grown.plants.size());
    for (std::size_t i = 0; i < grown.plants.size(); ++i) {
      const bool stands = grown.plants[i] != ecosystem::no_plant;
      layer.probabilities[i] =
          stands ? static_cast<std::uint16_t>(grown.before_corners.probability[i] * 65535.0f + 0.5f) : std::uint16_t{0};
    }
  }
  layer.tile_set = std::move(grown.tile_set);
  layer.tiling = std::move(grown.tiling);
  layer.north_west = grown.north_west;
  layer.plants = std::move(grown.plants);
  return layer;
}

}  // namespace

GrownLayer grow_layer(const config::Scenario& scenario, std::size_t index, const fields::FieldSet& fields,
                      const base::Progress& progress, std::vector<std::pair<std::string, double>>& seconds,
                      std::optional<base::Point> watch) {
  const config::LayerSettings& settings = scenario.layers[index];
  const std::uint64_t seed = population::layer_seed(scenario.seed, index);
  const auto number = static_cast<std::uint32_t>(index);
  const base::Box extent = fields.frame.extent;
  GrownLayer grown;

  // 1. Fill the Wang tiles with Poisson discs (section 4.1).
  {
    Stopwatch stopwatch(seconds, "tiles");
    base::report(progress, "tiles", 0);
    grown.tile_set = tiles::fill_tiles(settings.tiles, scenario.seed, number);
  }
  // 2. Tile the land.
  {
    Stopwatch stopwatch(seconds, "tiling");
    const double side = grown.tile_set.side_m;
    const int columns = tiles_across(extent.width(), side, settings);
    const int rows = tiles_across(extent.height(), side, settings);
    check_memory(grown.tile_set, columns, rows, settings);
    grown.tiling = tiles::tile_land(grown.tile_set, columns, rows, scenario.seed, number);
    grown.north_west = {extent.west, extent.north};
    grown.offsets = ecosystem::site_offsets(grown.tile_set, grown.tiling);
  }
  const evaluators::Ground ground = grown.ground(fields);
  population::NeighbourhoodOptions competing;
  if (watch && (grown.watched = evaluators::nearest_site(ground, *watch))) competing.watch = grown.watched->index;

  // 3. Evaluate the place on every site (section 4.2).
  {
    Stopwatch stopwatch(seconds, "evaluate");
    const evaluators::Network network(scenario, index);
    grown.suitability = evaluators::evaluate_sites(network, ground, progress);
    grown.report.no_data = without_data(network, grown.suitability, fields);
  }
  // 4. Let neighbours compete (section 4.3).
  {
    Stopwatch stopwatch(seconds, "neighbours");
    if (settings.neighbourhoods.enabled) {
      population::Competition competition =
          population::compete(grown.suitability, ground, settings, seed, competing, progress);
      grown.before_corners = std::move(competition.population);
      grown.report.neighbourhoods = std::move(competition.report);
      grown.acting = std::move(competition.acting);
    } else {
      grown.before_corners = population::establish(grown.suitability, ground, settings, seed, progress);
    }
  }
  // 5. Solve the corner problem (section 4.4).
  {
    Stopwatch stopwatch(seconds, "corners");
    grown.plants = grown.before_corners.plants;
    grown.report.corners = population::prune_corners(grown.tile_set, grown.tiling, grown.offsets, grown.plants,
                                                     grown.before_corners.probability, settings.corners, progress);
  }

  LayerReport& report = grown.report;
  report.name = settings.name;
  report.sites = grown.offsets.back();
  report.tile_columns = grown.tiling.columns;
  report.tile_rows = grown.tiling.rows;
  report.tile_kinds = static_cast<int>(grown.tile_set.tiles.size());
  report.plants_by_species = count_plants(grown.plants, settings.species.size());
  for (const std::uint64_t count : report.plants_by_species) report.plants += count;
  return grown;
}

Simulation simulate(const config::Scenario& scenario, const SimulationOptions& options) {
  // Find what is wrong with Properties and Evaluators before the fields are loaded, which may take long.
  if (auto errors = evaluators::check(scenario); !errors.empty()) throw base::ConfigError(std::move(errors));

  Simulation simulation;
  SimulationReport& report = simulation.report;
  fields::FieldSet fields;
  {
    Stopwatch stopwatch(report.seconds, "fields");
    fields = fields::load_fields(scenario.scene, scenario.fields, options.progress);
    report.frame = fields::report_frame(fields.frame);
  }

  ecosystem::Ecosystem& ecosystem = simulation.ecosystem;
  ecosystem.name = scenario.name;
  ecosystem.crs_wkt = fields.frame.crs_wkt;
  ecosystem.extent = fields.frame.extent;
  for (std::size_t layer = 0; layer < scenario.layers.size(); ++layer) {
    GrownLayer grown = grow_layer(scenario, layer, fields, options.progress, report.seconds);
    report.layers.push_back(grown.report);
    ecosystem::SuitabilityMap map;
    if (options.probabilities) {
      Stopwatch stopwatch(report.seconds, "map");
      map = evaluators::map_suitability(grown.suitability, grown.ground(fields));
    }
    ecosystem.layers.push_back(finished(std::move(grown), scenario.layers[layer], options.probabilities));
    ecosystem.layers.back().suitability = std::move(map);
  }
  ecosystem.terrain = terrain_of(fields);
  ecosystem.provenance_json = provenance(scenario, fields);
  return simulation;
}

}  // namespace silvasim
