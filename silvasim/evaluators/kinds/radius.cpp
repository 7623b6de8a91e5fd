// RadiusEvaluator: can the plant's model be scaled to the site's size? The ratio site radius / model radius, which becomes
// the plant's scale, must lie in the species' scale range.
#include "silvasim/evaluators/kinds/kinds.h"

namespace silvasim::evaluators {

namespace {

class Radius final : public Evaluator {
 public:
  explicit Radius(const config::LayerSettings& layer) {
    for (const config::SpeciesSettings& species : layer.species) {
      ranges_.push_back({static_cast<float>(species.least_scale * species.model_radius_m),
                         static_cast<float>(species.most_scale * species.model_radius_m)});
    }
  }

  void evaluate(const SiteBlock& block, std::size_t species, float* result) const override {
    const Range range = ranges_[species];
    for (std::size_t i = 0; i < block.count; ++i) {
      result[i] = (block.radius_m[i] >= range.least) & (block.radius_m[i] <= range.most) ? 1.0f : 0.0f;
    }
  }

 private:
  struct Range {
    float least, most;
  };
  std::vector<Range> ranges_;
};

}  // namespace

EvaluatorType radius_evaluator() {
  return {
      config::evaluator_rule(
          "RadiusEvaluator",
          "Whether the plant's model can be scaled to the site: 1 where site radius / model radius lies in the plant's "
          "<scale>, else 0. Lethal unless said otherwise.",
          {}, {.datafield = false, .property = false, .lethal_by_default = true}, "<RadiusEvaluator/>"),
      FieldNeed::none, false, [](const EvaluatorMaking& making) -> std::unique_ptr<Evaluator> {
        return std::make_unique<Radius>(making.layer);
      }};
}

}  // namespace silvasim::evaluators
