#include "silvasim/evaluators/evaluator.h"

#include <algorithm>

#include "silvasim/evaluators/kinds/kinds.h"

namespace silvasim::evaluators {

namespace {

class Responding final : public Evaluator {
 public:
  explicit Responding(std::vector<std::unique_ptr<Response>> responses) : responses_(std::move(responses)) {}

  void evaluate(const SiteBlock& block, std::size_t species, float* result) const override {
    responses_[species]->apply(block.field, result, block.count);
  }

 private:
  std::vector<std::unique_ptr<Response>> responses_;
};

std::string list(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "<" : ", <") + word + ">";
  return text;
}

}  // namespace

const config::PropertySettings* EvaluatorMaking::property(std::size_t species) const {
  const int index = step.properties.empty() ? -1 : step.properties[species];
  return index < 0 ? nullptr : &layer.species[species].properties[static_cast<std::size_t>(index)];
}

std::vector<std::unique_ptr<Response>> EvaluatorMaking::responses(const std::vector<std::string>& accepted) const {
  std::vector<std::unique_ptr<Response>> responses;
  for (std::size_t s = 0; s < layer.species.size(); ++s) {
    const config::PropertySettings* asked = property(s);
    responses.push_back(nullptr);
    if (!asked || !asked->response.rule) continue;
    const std::string& kind = asked->response.rule->type;
    if (std::find(accepted.begin(), accepted.end(), kind) == accepted.end()) {
      errors.push_back({asked->response.place, "property \"" + asked->name + "\" of \"" + layer.species[s].name +
                                                   "\" is a <" + kind + ">, but <" + step.node.rule->tag + "> at " +
                                                   step.place.file + ":" + std::to_string(step.place.line) + " takes " +
                                                   list(accepted)});
    } else {
      responses.back() = make_response(asked->response, errors);
    }
  }
  return responses;
}

std::unique_ptr<Evaluator> respond(std::vector<std::unique_ptr<Response>> responses) {
  return std::make_unique<Responding>(std::move(responses));
}

const std::vector<EvaluatorType>& evaluator_types() {
  static const std::vector<EvaluatorType> types = {
      radius_evaluator(), minmax_evaluator(),   function_evaluator(), gradient_evaluator(),
      class_evaluator(),  distance_evaluator(), constant_evaluator(), normalize_evaluator(),
  };
  return types;
}

const config::Dialect& dialect() {
  static const config::Dialect whole = [] {
    std::vector<config::ElementRule> properties, evaluators;
    for (const PropertyType& type : property_types()) properties.push_back(type.rule);
    for (const EvaluatorType& type : evaluator_types()) evaluators.push_back(type.rule);
    return config::make_dialect(std::move(properties), std::move(evaluators));
  }();
  return whole;
}

}  // namespace silvasim::evaluators
