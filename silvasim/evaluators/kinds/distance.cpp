// DistanceEvaluator: keeps crowns off features (roads, buildings, water), or near them. The distance is measured from the
// crown's rim, not from the stem: the field's distance less the site's radius.
#include "silvasim/config/value.h"
#include "silvasim/evaluators/kinds/kinds.h"

namespace silvasim::evaluators {

namespace {

class Distance final : public Evaluator {
 public:
  Distance(float least, float most) : least_(least), most_(most) {}

  void evaluate(const SiteBlock& block, std::size_t, float* result) const override {
    for (std::size_t i = 0; i < block.count; ++i) {
      const float gap = block.field[i] - block.radius_m[i];
      result[i] = (gap >= least_) & (gap <= most_) ? 1.0f : 0.0f;
    }
  }

 private:
  float least_, most_;
};

}  // namespace

EvaluatorType distance_evaluator() {
  return {
      config::evaluator_rule(
          "DistanceEvaluator",
          "Keeps crowns away from features, or near them: 1 where the distance from the crown's rim (the data field's "
          "metres less the site's radius) lies between least and most. Lethal unless said otherwise.",
          {{"least", config::ValueType::length, "least free distance between crown and feature", false, "", {}, 0},
           {"most", config::ValueType::length, "greatest distance at which the plant still grows", false, "", {}, 0}},
          {.property = false, .lethal_by_default = true},
          "<DistanceEvaluator least=\"5 m\"><datafield>to_road</datafield></DistanceEvaluator>"),
      FieldNeed::value, false, [](const EvaluatorMaking& making) -> std::unique_ptr<Evaluator> {
        const config::Node& node = making.step.node;
        constexpr double anywhere = 1e9;
        const double least = node.has("least") ? node.number("least") : -anywhere;
        const double most = node.has("most") ? node.number("most") : anywhere;
        if (!node.has("least") && !node.has("most")) {
          making.errors.push_back({node.place, "<DistanceEvaluator> needs least or most, like least=\"5 m\""});
        }
        if (least > most) {
          making.errors.push_back({node.place, "<DistanceEvaluator> reversed: least=\"" + config::to_text(least) +
                                                   " m\" is above most=\"" + config::to_text(most) + " m\""});
        }
        return std::make_unique<Distance>(static_cast<float>(least), static_cast<float>(most));
      }};
}

}  // namespace silvasim::evaluators
