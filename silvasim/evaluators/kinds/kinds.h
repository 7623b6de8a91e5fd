// The Evaluators, one a file. To add one: its file, its line here and in evaluator_types().
#pragma once

#include "silvasim/evaluators/evaluator.h"

namespace silvasim::evaluators {

EvaluatorType radius_evaluator();
EvaluatorType minmax_evaluator();
EvaluatorType function_evaluator();
EvaluatorType gradient_evaluator();
EvaluatorType class_evaluator();
EvaluatorType distance_evaluator();
EvaluatorType constant_evaluator();
EvaluatorType normalize_evaluator();

}  // namespace silvasim::evaluators
