// ConstantEvaluator: the same factor on every site, for all plants alike or by each plant's Constant property.
#include <algorithm>

#include "silvasim/evaluators/kinds/kinds.h"

namespace silvasim::evaluators {

namespace {

class ConstantFactor final : public Evaluator {
 public:
  explicit ConstantFactor(float value) : value_(value) {}

  void evaluate(const SiteBlock& block, std::size_t, float* result) const override {
    std::fill_n(result, block.count, value_);
  }

 private:
  float value_;
};

}  // namespace

EvaluatorType constant_evaluator() {
  return {
      config::evaluator_rule(
          "ConstantEvaluator", "The same factor on every site: the attribute value, or each plant's Constant property.",
          {{"value", config::ValueType::fraction, "the factor, where no <property> is named", false, "", {}, 0, 1}},
          {.datafield = false, .property_optional = true},
          "<ConstantEvaluator><property>Vigour</property></ConstantEvaluator>"),
      FieldNeed::none, false, [](const EvaluatorMaking& making) -> std::unique_ptr<Evaluator> {
        const config::Node& node = making.step.node;
        const bool by_property = node.child("PropertyReference") != nullptr;
        if (by_property == node.has("value")) {
          making.errors.push_back({node.place, "<ConstantEvaluator> needs either value=\"...\" or a <property>"});
          return nullptr;
        }
        if (by_property) return respond(making.responses({"Constant"}));
        return std::make_unique<ConstantFactor>(static_cast<float>(node.number("value")));
      }};
}

}  // namespace silvasim::evaluators
