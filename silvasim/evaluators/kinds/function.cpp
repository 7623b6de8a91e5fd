// FunctionEvaluator: the plant's response to the field's value, by any Property that is a function of a quantity.
#include "silvasim/evaluators/kinds/kinds.h"

namespace silvasim::evaluators {

EvaluatorType function_evaluator() {
  return {config::evaluator_rule(
              "FunctionEvaluator",
              "The plant's response to the data field's value: its property may be a Gauss, Bezier, Table, Trapezoid, "
              "MinMax or Constant.",
              {}, {},
              "<FunctionEvaluator><datafield>moisture</datafield><property>Moisture</property></FunctionEvaluator>"),
          FieldNeed::value, false, [](const EvaluatorMaking& making) {
            return respond(making.responses({"Gauss", "Bezier", "Table", "Trapezoid", "MinMax", "Constant"}));
          }};
}

}  // namespace silvasim::evaluators
