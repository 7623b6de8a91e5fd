// Every setting of a simulation, typed, in SI units, each with its place in the XML. Valid, or not made.
//
// References between parts are indices. Settings of Properties and Evaluators stay checked nodes, because only their own
// files know what they mean.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "silvasim/base/place.h"
#include "silvasim/config/corner_settings.h"
#include "silvasim/config/field_settings.h"
#include "silvasim/config/node.h"
#include "silvasim/config/tile_settings.h"

namespace silvasim::config {

struct PropertySettings {
  std::string name;
  Node response;  // the element inside <property>: <MinMax>, <Gauss>, ...
};

inline constexpr double unbounded_scale =
    1e9;  // finite, so that it may pass through rooms that compile without infinities

struct SpeciesSettings {
  std::string name;
  std::string common_name;
  base::Place place;
  std::uint32_t colour = 0;    // 0xRRGGBB
  std::string model;           // as written; may be empty
  double model_radius_m = 4;   // crown radius at scale 1
  double height_m = 16;        // at scale 1
  double stem_radius_m = 0.2;  // at scale 1
  double least_scale = 0;
  double most_scale = unbounded_scale;
  double fon_radius_m = 8;  // radius of the field of neighbourhood at scale 1
  std::vector<PropertySettings> properties;
};

// One step of the pipeline: an evaluator, or a group of steps.
struct StepSettings {
  enum class Kind { evaluator, product, length };
  Kind kind = Kind::evaluator;
  base::Place place;
  std::vector<StepSettings> steps;  // of a group

  // Of an evaluator:
  int evaluator = -1;  // index into Dialect::evaluators
  Node node;
  bool lethal = false;
  double floor = 0.01;
  int field = -1;               // index into Scenario::fields; -1: needs none
  std::vector<int> properties;  // a species: index into its properties; -1: none, or the evaluator skips the species
  std::vector<bool> applies;    // a species: whether the evaluator acts on it
};

struct NeighbourhoodSettings {
  bool enabled = false;
  double cell_m = 0;  // 0: from the density of the sites
  int passes = 2;
  double fmin = 0.1;
  std::vector<double> influence;  // species x species, [from * count + on]
};

enum class Selection { most_likely, weighted };
enum class Chance { stochastic, certain };

struct LayerSettings {
  std::string name;
  base::Place place;
  TileSettings tiles;
  StepSettings pipeline;  // a group
  Selection selection = Selection::most_likely;
  Chance chance = Chance::stochastic;
  NeighbourhoodSettings neighbourhoods;
  CornerSolver corners = CornerSolver::optimal;
  std::vector<SpeciesSettings> species;
};

// A configuration file as it was read, for provenance.
struct SourceFile {
  std::string path;  // as named on the command line or in the XML
  std::string text;
  std::string sha256;
};

struct Scenario {
  std::string name;
  std::uint64_t seed = 1;
  SceneSettings scene;
  std::vector<FieldSettings> fields;
  std::vector<LayerSettings> layers;  // one at least
  std::vector<SourceFile> files;      // in the order of reading
  std::string sha256;                 // of all files together
};

}  // namespace silvasim::config
