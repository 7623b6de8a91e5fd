// <Gauss mean="0.6" deviation="0.2"/>: exp(-(x - mean)² / (2 deviation²)).
#include "silvasim/base/math.h"
#include "silvasim/base/vector_clones.h"
#include "silvasim/evaluators/properties/properties.h"

namespace silvasim::evaluators {

namespace {

SILVA_VECTOR_CLONES void bell(float mean, float scale, const float* x, float* y, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const float off = x[i] - mean;
    y[i] = base::exp(off * off * scale);
  }
}

class Gauss final : public Response {
 public:
  Gauss(float mean, float deviation) : mean_(mean), scale_(-0.5f / (deviation * deviation)) {}

  void apply(const float* x, float* y, std::size_t count) const override { bell(mean_, scale_, x, y, count); }

 private:
  float mean_, scale_;
};

std::unique_ptr<Response> make(const config::Node& node, std::vector<base::Diagnostic>&) {
  return std::make_unique<Gauss>(static_cast<float>(node.number("mean")), static_cast<float>(node.number("deviation")));
}

}  // namespace

PropertyType gauss_property() {
  return {{"Gauss",
           "Gauss",
           "A bell curve, 1 at the mean: exp(-(x - mean)² / (2 deviation²)).",
           {{"mean", config::ValueType::number, "where the plant does best", true, "", {}},
            {"deviation", config::ValueType::number, "standard deviation, above 0", true, "", {}, 1e-9}},
           {},
           config::ValueType::none,
           true,
           "<Gauss mean=\"0.6\" deviation=\"0.2\"/>"},
          make};
}

}  // namespace silvasim::evaluators
