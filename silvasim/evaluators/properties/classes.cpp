// <Classes otherwise="0"><class code="5" value="1"/></Classes>: a probability for each class of a class field.
#include <algorithm>

#include "silvasim/evaluators/properties/properties.h"

namespace silvasim::evaluators {

namespace {

class Classes final : public Response {
 public:
  explicit Classes(float otherwise) : otherwise_(otherwise) {}

  void add(float code, float value) { classes_.push_back({code, value}); }

  void apply(const float* x, float* y, std::size_t count) const override {
    std::fill_n(y, count, otherwise_);
    for (const Class c : classes_) {
      for (std::size_t i = 0; i < count; ++i) y[i] = x[i] == c.code ? c.value : y[i];
    }
  }

 private:
  struct Class {
    float code, value;
  };
  float otherwise_;
  std::vector<Class> classes_;
};

std::unique_ptr<Response> make(const config::Node& node, std::vector<base::Diagnostic>& errors) {
  auto response = std::make_unique<Classes>(static_cast<float>(node.number("otherwise")));
  std::vector<double> seen;
  for (const config::Node* entry : node.all("ClassValue")) {
    const double code = entry->number("code");
    if (std::find(seen.begin(), seen.end(), code) != seen.end()) {
      errors.push_back({entry->place, "<Classes>: the code stands twice"});
    }
    seen.push_back(code);
    response->add(static_cast<float>(code), static_cast<float>(entry->number("value")));
  }
  return response;
}

}  // namespace

PropertyType classes_property() {
  return {{"Classes",
           "Classes",
           "A probability for each class of a data field with kind=\"class\".",
           {{"otherwise", config::ValueType::fraction, "the probability in all other classes", false, "0", {}, 0, 1}},
           {{"ClassValue", 1, -1}},
           config::ValueType::none,
           true,
           "<Classes otherwise=\"0\"><class code=\"5\" value=\"1\"/><class code=\"3\" value=\"0.4\"/></Classes>"},
          make};
}

}  // namespace silvasim::evaluators
