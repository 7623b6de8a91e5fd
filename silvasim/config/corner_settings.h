// What a user may say about pruning the corner graph of a vegetation layer.
#pragma once

namespace silvasim::config {

enum class CornerSolver {
  optimal,  // exact: the independent set of greatest weight, component by component
  paper,    // the paper's heuristic w_ext
};

}  // namespace silvasim::config
