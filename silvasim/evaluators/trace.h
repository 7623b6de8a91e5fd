// The pipeline followed step by step on one site, for explanations. A second, scalar way to the engine's result.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "silvasim/evaluators/suitability.h"

namespace silvasim::evaluators {

// One step: an evaluator, a group after what stands in it, or a normalization.
struct TraceRow {
  base::Place place;
  std::string tag;             // "MinMaxEvaluator", "length", "NormalizeEvaluator"
  int depth = 0;               // 0: in the pipeline itself
  std::string field;           // name; empty where it reads none
  std::optional<float> value;  // of the field at the site; none where it has no data
  // One entry a species: what the step said (none where it does not act on the species), and the probability so far;
  // `excluded` where the species is out. Inside a group the probability so far is the group's.
  std::vector<std::optional<float>> result;
  std::vector<float> running;
};

// `site`: sampled columns of one site. `maxima`: Suitability::maxima.
std::vector<TraceRow> trace(const Network& network, const config::Scenario& scenario, const SiteColumns& site,
                            const std::vector<float>& maxima);

}  // namespace silvasim::evaluators
