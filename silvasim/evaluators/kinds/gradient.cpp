// GradientEvaluator: thins plants out where the field runs from `from` to `to`: 1 at `from` and before, falling in a
// straight line to 0 at `to` and beyond. `from` may be above `to`.
#include "silvasim/evaluators/kinds/kinds.h"
#include "silvasim/evaluators/properties/piecewise.h"

namespace silvasim::evaluators {

namespace {

class Gradient final : public Evaluator {
 public:
  Gradient(float from, float to)
      : curve_(from < to ? std::vector<CurvePoint>{{from, 1}, {to, 0}} : std::vector<CurvePoint>{{to, 0}, {from, 1}}) {}

  void evaluate(const SiteBlock& block, std::size_t, float* result) const override {
    curve_.apply(block.field, result, block.count);
  }

 private:
  PiecewiseLinear curve_;
};

}  // namespace

EvaluatorType gradient_evaluator() {
  return {config::evaluator_rule(
              "GradientEvaluator",
              "Thins plants out along a data field: 1 up to the value `from`, falling in a straight line to 0 at `to`. "
              "Name "
              "plants inside to limit it to them.",
              {{"from", config::ValueType::number, "where the plants still stand in full", true, "", {}},
               {"to", config::ValueType::number, "where none is left", true, "", {}}},
              {.property = false},
              "<GradientEvaluator from=\"1700\" to=\"1950\"><datafield>elevation</datafield></GradientEvaluator>"),
          FieldNeed::value, false, [](const EvaluatorMaking& making) -> std::unique_ptr<Evaluator> {
            const double from = making.step.node.number("from"), to = making.step.node.number("to");
            if (from == to) {
              making.errors.push_back(
                  {making.step.place, "<GradientEvaluator>: from and to are equal; a step is a MinMaxEvaluator"});
              return nullptr;
            }
            return std::make_unique<Gradient>(static_cast<float>(from), static_cast<float>(to));
          }};
}

}  // namespace silvasim::evaluators
