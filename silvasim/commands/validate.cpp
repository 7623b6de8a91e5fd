// silvasim validate: everything that can be said about a configuration without growing it.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "silvasim/base/error.h"
#include "silvasim/commands/commands.h"
#include "silvasim/commands/console.h"
#include "silvasim/config/schema.h"
#include "silvasim/evaluators/network.h"

namespace silvasim::commands {

namespace {

nlohmann::ordered_json as_json(const std::vector<base::Diagnostic>& errors) {
  auto list = nlohmann::ordered_json::array();
  for (const base::Diagnostic& error : errors) {
    list.push_back({{"file", error.place.file},
                    {"line", error.place.line},
                    {"column", error.place.column},
                    {"message", error.message}});
  }
  return list;
}

}  // namespace

void validate(const ValidateOptions& options) {
  std::vector<base::Diagnostic> errors;
  config::Scenario scenario;
  try {
    scenario = load(options.scenario);
    errors = evaluators::check(scenario);
    const std::string schema = config::xml_schema(evaluators::dialect());
    for (const config::SourceFile& file : scenario.files) {
      const auto found = config::check_against_schema(file.text, file.path, schema);
      errors.insert(errors.end(), found.begin(), found.end());
    }
  } catch (const base::ConfigError& error) {
    errors = error.diagnostics();
  }
  if (options.common.json) {
    fmt::print("{}\n", nlohmann::ordered_json{{"valid", errors.empty()}, {"errors", as_json(errors)}}.dump(2));
  }
  if (!errors.empty()) throw base::ConfigError(std::move(errors));
  if (options.common.json || options.common.quiet) return;
  std::size_t species = 0;
  for (const config::LayerSettings& layer : scenario.layers) species += layer.species.size();
  fmt::print("{}: valid; {} layer{}, {} species, {} data field{}\n", options.scenario.ecosystem.string(),
             scenario.layers.size(), scenario.layers.size() == 1 ? "" : "s", species, scenario.fields.size(),
             scenario.fields.size() == 1 ? "" : "s");
}

}  // namespace silvasim::commands
