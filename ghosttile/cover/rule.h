// A rule says how much of a detail there is at a place: responses to quantities of the place, combined.
//
// Promise: values in [0, 1], a pure function of the place; bounds are sound. No data: what the source says (Source::without_data).
// Threads: immutable. Cost: that of its sources, and 1 to 3 ns a point and response; a product asks no more once all is 0.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "ghosttile/cover/response_range.h"
#include "ghosttile/cover/source.h"
#include "ghosttile/density/field.h"
#include "silvasim/evaluators/response.h"

namespace ghosttile::cover {

enum class Combine { product, least, greatest };

// Either a response to a source, or a rule.
struct Factor {
  std::shared_ptr<const Source> source;
  std::shared_ptr<const silvasim::evaluators::Response> response;  // null: the source's own value, cut to [0, 1]
  std::optional<ResponseRange> response_range;                     // with a response
  std::shared_ptr<const density::Plane> rule;
};

class Rule final : public density::Plane {
 public:
  // One factor at least.
  Rule(Combine combine, std::vector<Factor> factors) : combine_(combine), factors_(std::move(factors)) {}

  void sample(const V3d& origin, const float* x, const float* y, std::size_t count, float* value) const override;
  Range bounds(double west, double south, double east, double north) const override;

 private:
  Combine combine_;
  std::vector<Factor> factors_;
};

}  // namespace ghosttile::cover
