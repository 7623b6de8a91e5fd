// MinMaxEvaluator: is the field's value in the plant's range? With optimum="true" the answer falls from 1 in the middle of
// the range to 0 at its ends: 1 - |x - mid| / half-width.
#include "silvasim/evaluators/kinds/kinds.h"

namespace silvasim::evaluators {

namespace {

class MinMaxOptimum final : public Evaluator {
 public:
  explicit MinMaxOptimum(const EvaluatorMaking& making) {
    for (std::size_t s = 0; s < making.layer.species.size(); ++s) {
      const config::PropertySettings* property = making.property(s);
      if (!property) {
        tents_.push_back({});
        continue;
      }
      const double least = property->response.number("min"), most = property->response.number("max");
      const double half = (most - least) / 2;
      tents_.push_back({static_cast<float>(least), static_cast<float>(most), static_cast<float>((least + most) / 2),
                        half > 0 ? static_cast<float>(1 / half) : 0.0f});
    }
  }

  void evaluate(const SiteBlock& block, std::size_t species, float* result) const override {
    const Tent tent = tents_[species];
    for (std::size_t i = 0; i < block.count; ++i) {
      const float x = block.field[i];
      const float off = x > tent.middle ? x - tent.middle : tent.middle - x;
      const float height = 1.0f - off * tent.reciprocal_half;
      const float inside = height > 0.0f ? height : 0.0f;
      result[i] = (x >= tent.least) & (x <= tent.most) ? inside : 0.0f;
    }
  }

 private:
  struct Tent {
    float least = 0, most = 0, middle = 0, reciprocal_half = 0;
  };
  std::vector<Tent> tents_;
};

}  // namespace

EvaluatorType minmax_evaluator() {
  return {config::evaluator_rule(
              "MinMaxEvaluator",
              "Whether the data field's value lies in the plant's MinMax property, ends included: 1 or 0.",
              {{"optimum",
                config::ValueType::boolean,
                "falls from 1 in the middle of the range to 0 at its ends, instead of 1 or 0",
                false,
                "false",
                {}}},
              {},
              "<MinMaxEvaluator lethal=\"true\" optimum=\"false\"><datafield>Waterfield</datafield>"
              "<property>MinMaxWater</property></MinMaxEvaluator>"),
          FieldNeed::value, false, [](const EvaluatorMaking& making) -> std::unique_ptr<Evaluator> {
            auto responses = making.responses({"MinMax"});
            if (!making.errors.empty()) return nullptr;
            if (making.step.node.boolean("optimum")) return std::make_unique<MinMaxOptimum>(making);
            return respond(std::move(responses));
          }};
}

}  // namespace silvasim::evaluators
