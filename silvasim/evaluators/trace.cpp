#include "silvasim/evaluators/trace.h"

#include <algorithm>
#include <cmath>

namespace silvasim::evaluators {

namespace {

using Kind = config::StepSettings::Kind;

// The joined value of the steps so far, for one species.
struct Joined {
  Kind kind = Kind::product;
  float product = 1;
  float squares = 0;
  int components = 0;

  void add(float component) {
    product *= component;
    squares += component * component;
    ++components;
  }
  float value() const {
    if (kind == Kind::product) return product;
    return components == 0 ? 1.0f : std::sqrt(std::min(squares * (1.0f / static_cast<float>(components)), 1.0f));
  }
};

class Tracer {
 public:
  Tracer(const Network& network, const config::Scenario& scenario, const SiteColumns& site)
      : network_(network), scenario_(scenario), block_(site.block()), alive_(network.species(), true) {}

  std::vector<TraceRow> run(const std::vector<float>& maxima) {
    std::vector<Joined> joined(network_.species());
    for (Joined& j : joined) j.kind = network_.combine();
    for (std::size_t stage = 0; stage < network_.stages(); ++stage) {
      if (stage > 0) normalize(maxima[stage - 1], joined);
      follow(network_.steps()[stage], 0, joined);
    }
    return std::move(rows_);
  }

 private:
  void normalize(float most, std::vector<Joined>& joined) {
    TraceRow row;
    row.tag = "NormalizeEvaluator";
    for (Joined& j : joined) {
      const float value = most > 0 ? j.value() / most : j.value();
      j = {j.kind};
      j.add(value);
      row.result.push_back(value);
    }
    finish(row, joined);
  }

  void follow(const std::vector<Step>& steps, int depth, std::vector<Joined>& joined) {
    for (const Step& step : steps) {
      TraceRow row;
      row.place = step.settings->place;
      row.depth = depth;
      row.result.resize(network_.species());
      if (step.kind == Kind::evaluator) {
        evaluate(step, row);
      } else {
        std::vector<Joined> inner(network_.species());
        for (Joined& j : inner) j.kind = step.kind;
        follow(step.steps, depth + 1, inner);
        row.tag = step.kind == Kind::length ? "length" : "product";
        for (std::size_t s = 0; s < inner.size(); ++s) {
          if (inner[s].components > 0) row.result[s] = inner[s].value();
        }
      }
      for (std::size_t s = 0; s < joined.size(); ++s) {
        if (!row.result[s]) continue;
        const bool floored = step.kind == Kind::evaluator && !step.settings->lethal && joined[s].kind == Kind::product;
        joined[s].add(floored ? std::max(*row.result[s], static_cast<float>(step.settings->floor)) : *row.result[s]);
      }
      finish(row, joined);
    }
  }

  void evaluate(const Step& step, TraceRow& row) {
    row.tag = step.settings->node.rule->tag;
    const bool reads = step.column >= 0;
    const auto column = static_cast<std::size_t>(std::max(step.column, 0));
    const bool missing = reads && step.missing_possible && block_.no_data[column] && block_.no_data[column][0];
    if (reads) {
      row.field = scenario_.fields[static_cast<std::size_t>(step.settings->field)].name;
      if (!missing) row.value = block_.value[column][0];
    }
    for (std::size_t s = 0; s < network_.species(); ++s) {
      if (!step.settings->applies[s]) continue;
      float result = 1;
      if (!missing) step.evaluator->evaluate({1, block_.radius_m, reads ? block_.value[column] : nullptr}, s, &result);
      row.result[s] = result;
      if (missing && step.missing_excludes) alive_[s] = false;
      if (step.settings->lethal && !(result > 0)) alive_[s] = false;
    }
  }

  void finish(TraceRow& row, const std::vector<Joined>& joined) {
    for (std::size_t s = 0; s < joined.size(); ++s) row.running.push_back(alive_[s] ? joined[s].value() : excluded);
    rows_.push_back(std::move(row));
  }

  const Network& network_;
  const config::Scenario& scenario_;
  Network::Block block_;
  std::vector<bool> alive_;
  std::vector<TraceRow> rows_;
};

}  // namespace

std::vector<TraceRow> trace(const Network& network, const config::Scenario& scenario, const SiteColumns& site,
                            const std::vector<float>& maxima) {
  return Tracer(network, scenario, site).run(maxima);
}

}  // namespace silvasim::evaluators
