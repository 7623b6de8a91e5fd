// How a species answers to a value of a data field: a function from a float to [0,1], worked out from a Property.
//
// Threads: immutable after construction. Values are finite; no data is dealt with before.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "silvasim/base/error.h"
#include "silvasim/config/node.h"

namespace silvasim::evaluators {

class Response {
 public:
  virtual ~Response() = default;

  // y[i] = response to x[i], for i in [0, count). One call a block, never a site.
  virtual void apply(const float* x, float* y, std::size_t count) const = 0;
};

// One kind of Property: its grammar, and how to make its response. Each stands in a file of its own in properties/, and in
// the table of property_types().
struct PropertyType {
  config::ElementRule rule;

  // The node obeys the rule. What is wrong beyond it (a reversed range) goes to `errors`.
  std::unique_ptr<Response> (*make)(const config::Node& node, std::vector<base::Diagnostic>& errors);
};

const std::vector<PropertyType>& property_types();

// The response of a checked <property> child; null where errors were added.
std::unique_ptr<Response> make_response(const config::Node& node, std::vector<base::Diagnostic>& errors);

}  // namespace silvasim::evaluators
