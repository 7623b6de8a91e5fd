// Evaluators: link the plants' Properties to data fields, and say how well each species does on each site.
//
// Each kind stands in a file of its own in kinds/, and in the table of evaluator_types(). An evaluator works on a block of
// sites and one species at a time, so that its loops run over plain columns: one virtual call a block, none a site.
// Source: Silva 2013, section 4.2.2; docs/reading.md, B1 to B5.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "silvasim/base/error.h"
#include "silvasim/config/scenario.h"
#include "silvasim/evaluators/response.h"

namespace silvasim::evaluators {

// What an evaluator sees of a block of sites. Columns of `count` values.
struct SiteBlock {
  std::size_t count = 0;
  const float* radius_m = nullptr;  // of the sites, which is the plants' crown radius
  const float* field = nullptr;     // the evaluator's data field, finite; null where it has none
};

class Evaluator {
 public:
  virtual ~Evaluator() = default;

  // result[i] in [0,1]: how the species does on site i.
  virtual void evaluate(const SiteBlock& block, std::size_t species, float* result) const = 0;
};

struct EvaluatorMaking {
  const config::StepSettings& step;
  const config::LayerSettings& layer;
  std::vector<base::Diagnostic>& errors;

  // The property that the step asks of a species; null where it asks for none or does not act on the species.
  const config::PropertySettings* property(std::size_t species) const;

  // The species' responses, one a species, null where there is none. Properties of other kinds than `accepted` are errors.
  std::vector<std::unique_ptr<Response>> responses(const std::vector<std::string>& accepted) const;
};

// An evaluator whose result is the species' response to its field.
std::unique_ptr<Evaluator> respond(std::vector<std::unique_ptr<Response>> responses);

enum class FieldNeed { none, value, class_code };

struct EvaluatorType {
  config::ElementRule rule;
  FieldNeed field = FieldNeed::value;
  bool normalizes = false;  // divides by the largest probability of all sites and species: a barrier, not an evaluator
  std::unique_ptr<Evaluator> (*make)(const EvaluatorMaking& making) = nullptr;
};

const std::vector<EvaluatorType>& evaluator_types();

// The whole dialect: the fixed part, the Properties and the Evaluators. Lives as long as the program.
const config::Dialect& dialect();

}  // namespace silvasim::evaluators
