// ClassEvaluator: the plant's probability in the class (soil type, land use) that the field holds.
#include "silvasim/evaluators/kinds/kinds.h"

namespace silvasim::evaluators {

EvaluatorType class_evaluator() {
  return {config::evaluator_rule(
              "ClassEvaluator",
              "The plant's probability in the class that the data field (kind=\"class\") holds, by its "
              "Classes property.",
              {}, {},
              "<ClassEvaluator "
              "lethal=\"true\"><datafield>landuse</datafield><property>LandUse</property></ClassEvaluator>"),
          FieldNeed::class_code, false,
          [](const EvaluatorMaking& making) { return respond(making.responses({"Classes"})); }};
}

}  // namespace silvasim::evaluators
