// NormalizeEvaluator: divides the probabilities reached so far by the largest of all sites and species, so that what comes
// after works on the whole range again. All zero stays zero. The engine waits for every site before it goes on.
#include "silvasim/evaluators/kinds/kinds.h"

namespace silvasim::evaluators {

EvaluatorType normalize_evaluator() {
  config::ElementRule rule;
  rule.type = rule.tag = "NormalizeEvaluator";
  rule.help =
      "Divides the probabilities reached so far by the largest of all sites and plants, so that it becomes 1. Stands "
      "in the pipeline itself, not in a group.";
  rule.example = "<NormalizeEvaluator/>";
  return {std::move(rule), FieldNeed::none, true, nullptr};
}

}  // namespace silvasim::evaluators
