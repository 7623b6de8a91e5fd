#include "silvasim/evaluators/network.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "silvasim/base/vector_clones.h"

namespace silvasim::evaluators {

namespace {

using Kind = config::StepSettings::Kind;

struct Making {
  const config::Scenario& scenario;
  const config::LayerSettings& layer;
  std::vector<int>& fields;
  std::vector<base::Diagnostic>& errors;

  int column(int field) {
    const auto found = std::find(fields.begin(), fields.end(), field);
    if (found != fields.end()) return static_cast<int>(found - fields.begin());
    fields.push_back(field);
    return static_cast<int>(fields.size()) - 1;
  }

  Step make(const config::StepSettings& settings) {
    Step step;
    step.kind = settings.kind;
    step.settings = &settings;
    for (const config::StepSettings& below : settings.steps) step.steps.push_back(make(below));
    if (settings.kind == Kind::evaluator) make_evaluator(settings, step);
    return step;
  }

  void make_evaluator(const config::StepSettings& settings, Step& step) {
    const EvaluatorType& type = evaluator_types()[static_cast<std::size_t>(settings.evaluator)];
    if (type.normalizes) {
      errors.push_back({settings.place, "<" + type.rule.tag + "> must stand in the pipeline itself, not in a group"});
      return;
    }
    if (settings.field >= 0) {
      const config::FieldSettings& field = scenario.fields[static_cast<std::size_t>(settings.field)];
      check_kind(settings, type, field);
      step.column = column(settings.field);
      step.missing_excludes = field.no_data == config::NoDataPolicy::exclude;
      step.missing_possible = field.no_data != config::NoDataPolicy::fill;
    }
    step.evaluator = type.make({settings, layer, errors});
  }

  void check_kind(const config::StepSettings& settings, const EvaluatorType& type, const config::FieldSettings& field) {
    const bool classes = field.kind == config::FieldKind::class_code;
    if (classes && type.field == FieldNeed::value) {
      errors.push_back({settings.place, "<" + type.rule.tag + "> needs a quantity, but data field \"" + field.name +
                                            "\" holds classes; use a <ClassEvaluator>"});
    }
    if (!classes && type.field == FieldNeed::class_code) {
      errors.push_back(
          {settings.place, "<" + type.rule.tag + "> needs classes, but data field \"" + field.name +
                               "\" is a quantity; say kind=\"class\" there, or use a <FunctionEvaluator>"});
    }
  }
};

// The loops over a block's columns.

SILVA_VECTOR_CLONES void square(const float* one, float* result, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) result[i] = one[i] * one[i];
}

SILVA_VECTOR_CLONES void add_square(const float* one, float* result, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) result[i] += one[i] * one[i];
}

SILVA_VECTOR_CLONES void multiply(const float* one, float least, float* result, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) result[i] *= one[i] > least ? one[i] : least;
}

SILVA_VECTOR_CLONES void root_of_share(float share, float* result, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const float part = result[i] * share;
    result[i] = std::sqrt(part < 1.0f ? part : 1.0f);
  }
}

// A site stays alive where the result is above 0. Returns whether any is left.
SILVA_VECTOR_CLONES bool keep_alive(const float* result, float* alive, std::size_t n) {
  std::uint32_t any = 0;
  for (std::size_t i = 0; i < n; ++i) {
    alive[i] = result[i] > 0.0f ? alive[i] : 0.0f;
    any |= std::bit_cast<std::uint32_t>(alive[i]);
  }
  return any != 0;
}

void keep_alive_where_known(const std::uint8_t* no_data, float* alive, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) alive[i] = no_data[i] ? 0.0f : alive[i];
}

std::size_t depth_of(const std::vector<Step>& steps) {
  std::size_t depth = 1;
  for (const Step& step : steps) depth = std::max(depth, depth_of(step.steps) + 1);
  return depth;
}

std::vector<std::vector<Step>> make_stages(Making& making) {
  std::vector<std::vector<Step>> stages(1);
  for (const config::StepSettings& settings : making.layer.pipeline.steps) {
    const bool normalizes =
        settings.kind == Kind::evaluator && evaluator_types()[static_cast<std::size_t>(settings.evaluator)].normalizes;
    if (normalizes) {
      stages.emplace_back();
    } else {
      stages.back().push_back(making.make(settings));
    }
  }
  return stages;
}

// Runs steps for one species over one block. `alive` is 1 or 0 a site; a lethal zero or missing data makes it 0. Where
// nothing of the block is left alive, the steps to come are left out: lethal evaluators early in the pipeline save work.
class Runner {
 public:
  Runner(const Network::Block& block, std::size_t species, float* alive)
      : block_(block), species_(species), alive_(alive) {}

  // Joins the steps' results into `result`. `carried`, if any, is the first component. `scratch`: two columns a level.
  void join(Kind kind, const std::vector<Step>& steps, const float* carried, float* result, float* scratch) {
    const std::size_t n = block_.count;
    float* one = scratch;
    float components = 0;
    const bool length = kind == Kind::length;
    if (carried) {
      components = 1;
      length ? square(carried, result, n) : void(std::copy_n(carried, n, result));
    } else {
      std::fill_n(result, n, length ? 0.0f : 1.0f);
    }
    for (const Step& step : steps) {
      if (!any_alive_) return;  // the rest decides nothing
      if (!run(step, one, scratch + block_size)) continue;
      components += 1;
      if (length) {
        add_square(one, result, n);
      } else {
        const bool floored = step.kind == Kind::evaluator && !step.settings->lethal;
        const float least = floored ? static_cast<float>(step.settings->floor) : 0.0f;
        multiply(one, least, result, n);
      }
    }
    if (!length) return;
    if (components == 0) {
      std::fill_n(result, n, 1.0f);
      return;
    }
    root_of_share(1.0f / components, result, n);
  }

 private:
  // False where the step does not act on the species.
  bool run(const Step& step, float* result, float* scratch) {
    if (step.kind != Kind::evaluator) {
      if (!acts(step)) return false;
      join(step.kind, step.steps, nullptr, result, scratch);
      return true;
    }
    if (!acts(step)) return false;
    const std::size_t n = block_.count;
    const float* field = step.column < 0 ? nullptr : block_.value[static_cast<std::size_t>(step.column)];
    step.evaluator->evaluate({n, block_.radius_m, field}, species_, result);
    if (step.missing_possible) apply_missing(step, result);
    if (step.settings->lethal) {
      any_alive_ = keep_alive(result, alive_, n);
    }
    return true;
  }

  void apply_missing(const Step& step, float* result) {
    const std::uint8_t* no_data = block_.no_data[static_cast<std::size_t>(step.column)];
    if (!no_data) return;
    const std::size_t n = block_.count;
    for (std::size_t i = 0; i < n; ++i) result[i] = no_data[i] ? 1.0f : result[i];
    if (step.missing_excludes) keep_alive_where_known(no_data, alive_, n);
  }

  bool acts(const Step& step) const {
    if (step.kind == Kind::evaluator) return step.settings->applies[species_];
    return std::any_of(step.steps.begin(), step.steps.end(), [&](const Step& below) { return acts(below); });
  }

  const Network::Block& block_;
  std::size_t species_;
  float* alive_;
  bool any_alive_ = true;
};

}  // namespace

Network::Network(const config::Scenario& scenario, std::size_t layer) : layer_(scenario.layers[layer]) {
  std::vector<base::Diagnostic> errors;
  Making making{scenario, layer_, fields_, errors};
  stages_ = make_stages(making);
  if (!errors.empty()) throw base::ConfigError(std::move(errors));
  for (const auto& stage : stages_) depth_ = std::max(depth_, depth_of(stage));
}

void Network::run(std::size_t stage, const Block& block, Scratch& scratch, float* probability) const {
  const std::size_t n = block.count, count = species();
  scratch.columns.resize((3 + depth_) * block_size);
  float* alive = scratch.columns.data();
  float* carried = alive + block_size;
  float* result = carried + block_size;
  for (std::size_t s = 0; s < count; ++s) {
    std::fill_n(alive, n, 1.0f);
    if (stage > 0) {
      for (std::size_t i = 0; i < n; ++i) {
        const float before = probability[i * count + s];
        alive[i] = before >= 0.0f ? 1.0f : 0.0f;
        carried[i] = before >= 0.0f ? before : 0.0f;
      }
    }
    Runner(block, s, alive)
        .join(layer_.pipeline.kind, stages_[stage], stage > 0 ? carried : nullptr, result, result + block_size);
    for (std::size_t i = 0; i < n; ++i) probability[i * count + s] = alive[i] > 0.0f ? result[i] : excluded;
  }
}

std::vector<base::Diagnostic> check(const config::Scenario& scenario) {
  std::vector<base::Diagnostic> errors;
  for (const config::LayerSettings& layer : scenario.layers) {
    for (const config::SpeciesSettings& species : layer.species) {
      for (const config::PropertySettings& property : species.properties) {
        if (property.response.rule) make_response(property.response, errors);
      }
    }
    std::vector<int> fields;
    Making making{scenario, layer, fields, errors};
    make_stages(making);
  }
  // Several evaluators may ask for one property: say each finding once.
  std::vector<base::Diagnostic> once;
  for (base::Diagnostic& error : errors) {
    if (std::find(once.begin(), once.end(), error) == once.end()) once.push_back(std::move(error));
  }
  return once;
}

}  // namespace silvasim::evaluators
