// Why a plant stands at a point, or none: the whole simulation followed for one site.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "silvasim/evaluators/trace.h"
#include "silvasim/pipeline.h"

namespace silvasim {

// A plant near the site that acted on its subject.
struct NeighbourEffect {
  ecosystem::PlantId species = ecosystem::no_plant;
  double distance_m = 0;
  float strength = 0;  // of its field at the site, in [0,1]
  float factor = 1;    // by which it multiplied the subject's probability
};

struct SiteExplanation {
  std::string layer;
  std::vector<std::string> species;
  base::Point site;  // scene point
  std::optional<fields::GeographicPoint> geographic;
  double distance_m = 0;    // from the point asked for
  int column = 0, row = 0;  // tile position
  int tile = 0;             // index in the tile set
  std::uint32_t site_id = 0;
  float radius_m = 0;
  bool outside = false;  // the site lies outside the scene
  std::vector<evaluators::TraceRow> steps;
  std::vector<float> abiotic;  // probability a species after the pipeline
  ecosystem::PlantId candidate = ecosystem::no_plant;
  // Of whom the rest tells: the candidate; where neighbours left none, the species that the place alone suits best.
  ecosystem::PlantId subject = ecosystem::no_plant;
  float abiotic_probability = 0, probability = 0;  // of the subject, before and after the neighbours
  std::vector<NeighbourEffect> neighbours;         // that acted on it
  bool stood_before_corners = false;
  std::optional<NeighbourEffect> gave_way_to;  // the overlapping plant that stayed
  ecosystem::PlantId plant = ecosystem::no_plant;
  std::string sentence;
};

// One explanation a layer, for the site nearest to the point. `degrees`: the point is longitude (x) and latitude (y).
// Errors: base::Error where the point lies outside the scene.
std::vector<SiteExplanation> explain(const config::Scenario& scenario, base::Point at, bool degrees,
                                     const base::Progress& progress = {});

}  // namespace silvasim
