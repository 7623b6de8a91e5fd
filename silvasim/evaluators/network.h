// The Evaluator network: the pipeline of a vegetation layer, ready to run over blocks of sites.
//
// Probabilities are in [0,1]; a species that a lethal evaluator removed, or whose field has no data, is `excluded`, which
// is told apart from zero.
// Errors: base::ConfigError with every finding about Properties and Evaluators.
// Threads: immutable; run() may be called from any number of threads, each with a Scratch of its own.
// Cost: about 2 ns a site, species and evaluator on one core, reading the fields and writing the result included.
// Source: Silva 2013, section 4.2.3; docs/reading.md, B2 and B5.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "silvasim/evaluators/evaluator.h"

namespace silvasim::evaluators {

inline constexpr float excluded = -1.0f;

// Most sites in one block: the columns of a block stay in the first cache.
inline constexpr std::size_t block_size = 1024;

// One step of a pipeline with its evaluator made.
struct Step {
  config::StepSettings::Kind kind = config::StepSettings::Kind::evaluator;
  const config::StepSettings* settings = nullptr;
  std::unique_ptr<Evaluator> evaluator;
  int column = -1;                // of the field, in the block; -1: needs none
  bool missing_excludes = false;  // where the field has no data the species is excluded; else the step says 1 there
  bool missing_possible = false;  // the field may have no data at all; false: no look at the mask
  std::vector<Step> steps;
};

class Network {
 public:
  // The scenario must outlive the network. Throws base::ConfigError.
  Network(const config::Scenario& scenario, std::size_t layer);

  // Indices into Scenario::fields of the fields that the pipeline reads; a block has one column for each.
  const std::vector<int>& fields() const { return fields_; }

  std::size_t species() const { return layer_.species.size(); }

  // Stretches of the pipeline between NormalizeEvaluators; run in order, with a division by the maximum after each but
  // the last. One at least.
  std::size_t stages() const { return stages_.size(); }

  // The columns of a block. value and no_data: one pointer for each of fields().
  struct Block {
    std::size_t count = 0;  // at most block_size
    const float* radius_m = nullptr;
    std::vector<const float*> value;           // finite, also where there is no data
    std::vector<const std::uint8_t*> no_data;  // 1 where there is none; null: there is some everywhere
  };

  struct Scratch {
    std::vector<float> columns;
  };

  // Runs a stage: probability[i * species() + s] for sites i and species s, which from the second stage on must hold the
  // normalized result of the stage before.
  void run(std::size_t stage, const Block& block, Scratch& scratch, float* probability) const;

  const std::vector<std::vector<Step>>& steps() const { return stages_; }
  config::StepSettings::Kind combine() const { return layer_.pipeline.kind; }

 private:
  const config::LayerSettings& layer_;
  std::vector<int> fields_;
  std::vector<std::vector<Step>> stages_;
  std::size_t depth_ = 1;
};

// What is wrong with the scenario's Properties and Evaluators, beyond the grammar. Used by Network and by `validate`.
std::vector<base::Diagnostic> check(const config::Scenario& scenario);

}  // namespace silvasim::evaluators
