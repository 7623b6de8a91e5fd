#include "silvasim/commands/console.h"

#include "silvasim/config/load.h"
#include "silvasim/evaluators/evaluator.h"

namespace silvasim::commands {

config::Scenario load(const ScenarioOptions& options) {
  config::Scenario scenario = config::load_scenario(options.ecosystem, options.plants, evaluators::dialect());
  if (options.seed) scenario.seed = *options.seed;
  return scenario;
}

}  // namespace silvasim::commands
