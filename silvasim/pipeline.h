// The whole story: a Scenario becomes an Ecosystem.
//
// Errors: base::ConfigError for what the user can mend in the XML, base::Error while reading fields, base::Cancelled.
// Source: Silva 2013, section 4.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "silvasim/base/progress.h"
#include "silvasim/config/scenario.h"
#include "silvasim/ecosystem/ecosystem.h"
#include "silvasim/evaluators/suitability.h"
#include "silvasim/fields/field_set.h"
#include "silvasim/population/corners.h"
#include "silvasim/population/neighbourhoods.h"

namespace silvasim {

struct SimulationOptions {
  bool probabilities = false;  // keep each plant's growth probability, and a map of each species' suitability
  base::Progress progress;
};

// What happened in one layer.
struct LayerReport {
  std::string name;
  std::uint64_t sites = 0;  // on all tiles, inside the scene or not
  std::uint64_t plants = 0;
  std::vector<std::uint64_t> plants_by_species;
  int tile_columns = 0, tile_rows = 0, tile_kinds = 0;
  // Fields that have no data somewhere, and on which share of the sites inside the scene. Not those whose policy is fill.
  std::vector<std::pair<std::string, double>> no_data;
  population::NeighbourhoodReport neighbourhoods;  // passes = 0: none asked for
  population::CornerReport corners;
};

struct SimulationReport {
  fields::FrameReport frame;
  std::vector<LayerReport> layers;
  std::vector<std::pair<std::string, double>> seconds;  // a stage, in order; layers add up
};

struct Simulation {
  ecosystem::Ecosystem ecosystem;
  SimulationReport report;
};

Simulation simulate(const config::Scenario& scenario, const SimulationOptions& options = {});

// One layer on its way, for explanations: everything that simulate() throws away.
struct GrownLayer {
  tiles::TileSet tile_set;
  tiles::Tiling tiling;
  base::Point north_west;
  std::vector<std::uint64_t> offsets;
  evaluators::Suitability suitability;
  population::Population before_corners;
  std::vector<ecosystem::PlantId> plants;  // after the corners
  LayerReport report;
  std::optional<evaluators::SitePlace> watched;  // the site nearest to the point that was to be watched
  std::vector<population::ActingPlant> acting;   // the plants that acted on it

  evaluators::Ground ground(const fields::FieldSet& fields) const {
    return {tile_set, tiling, north_west, offsets, fields};
  }
};

GrownLayer grow_layer(const config::Scenario& scenario, std::size_t layer, const fields::FieldSet& fields,
                      const base::Progress& progress, std::vector<std::pair<std::string, double>>& seconds,
                      std::optional<base::Point> watch = {});

}  // namespace silvasim
