// <Constant value="0.8"/>: the same answer everywhere.
#include <algorithm>

#include "silvasim/evaluators/properties/properties.h"

namespace silvasim::evaluators {

namespace {

class Constant final : public Response {
 public:
  explicit Constant(float value) : value_(value) {}
  void apply(const float*, float* y, std::size_t count) const override { std::fill_n(y, count, value_); }

 private:
  float value_;
};

std::unique_ptr<Response> make(const config::Node& node, std::vector<base::Diagnostic>&) {
  return std::make_unique<Constant>(static_cast<float>(node.number("value")));
}

}  // namespace

PropertyType constant_property() {
  return {{"Constant",
           "Constant",
           "The same answer everywhere.",
           {{"value", config::ValueType::fraction, "the probability", true, "", {}, 0, 1}},
           {},
           config::ValueType::none,
           true,
           "<Constant value=\"0.8\"/>"},
          make};
}

}  // namespace silvasim::evaluators
