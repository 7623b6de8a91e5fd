// <MinMax min="0.2" max="0.5"/>: 1 from min to max, both included, else 0.
#include "silvasim/base/vector_clones.h"
#include "silvasim/config/value.h"
#include "silvasim/evaluators/properties/properties.h"

namespace silvasim::evaluators {

namespace {

SILVA_VECTOR_CLONES void within(float least, float most, const float* x, float* y, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) y[i] = (x[i] >= least) & (x[i] <= most) ? 1.0f : 0.0f;
}

class MinMax final : public Response {
 public:
  MinMax(float least, float most) : least_(least), most_(most) {}

  void apply(const float* x, float* y, std::size_t count) const override { within(least_, most_, x, y, count); }

 private:
  float least_, most_;
};

std::unique_ptr<Response> make(const config::Node& node, std::vector<base::Diagnostic>& errors) {
  const double least = node.number("min"), most = node.number("max");
  if (least > most) {
    errors.push_back({node.place, "<MinMax> reversed: min=\"" + config::to_text(least) + "\" is above max=\"" +
                                      config::to_text(most) + "\""});
  }
  return std::make_unique<MinMax>(static_cast<float>(least), static_cast<float>(most));
}

}  // namespace

PropertyType minmax_property() {
  return {{"MinMax",
           "MinMax",
           "A range in which the plant grows: 1 from min to max, both included, 0 outside. A MinMaxEvaluator with "
           "optimum=\"true\" makes it a tent with its top in the middle.",
           {{"min", config::ValueType::number, "least value", true, "", {}},
            {"max", config::ValueType::number, "greatest value", true, "", {}}},
           {},
           config::ValueType::none,
           true,
           "<MinMax min=\"0.2\" max=\"0.5\"/>"},
          make};
}

}  // namespace silvasim::evaluators
