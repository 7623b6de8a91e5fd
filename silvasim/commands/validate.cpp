// silvasim validate: everything that can be said about a configuration without growing it, the data fields included.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "silvasim/base/error.h"
#include "silvasim/commands/commands.h"
#include "silvasim/commands/console.h"
#include "silvasim/config/schema.h"
#include "silvasim/evaluators/network.h"
#include "silvasim/fields/field_set.h"
#include "silvasim/tiles/check.h"

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
  fields::FieldSet fields;
  try {
    scenario = load(options.scenario);
    errors = evaluators::check(scenario);
    for (const config::LayerSettings& layer : scenario.layers) {
      const auto found = tiles::faults(layer.tiles);
      errors.insert(errors.end(), found.begin(), found.end());
    }
    const std::string schema = config::xml_schema(evaluators::dialect());
    for (const config::SourceFile& file : scenario.files) {
      const auto found = config::check_against_schema(file.text, file.path, schema);
      errors.insert(errors.end(), found.begin(), found.end());
    }
    if (errors.empty() && !options.xml_only) {
      fields = fields::load_fields(scenario.scene, scenario.fields, console_progress(options.common));
    }
  } catch (const base::ConfigError& error) {
    errors = error.diagnostics();
  }
  end_progress(options.common);
  if (options.common.json) {
    fmt::print("{}\n", nlohmann::ordered_json{{"valid", errors.empty()}, {"errors", as_json(errors)}}.dump(2));
  }
  if (!errors.empty()) throw base::ConfigError(std::move(errors));
  if (options.common.json || options.common.quiet) return;
  std::size_t species = 0;
  for (const config::LayerSettings& layer : scenario.layers) species += layer.species.size();
  fmt::print("{}: valid; {} layer{}, {} species, {} data field{}{}\n", options.scenario.ecosystem.string(),
             scenario.layers.size(), scenario.layers.size() == 1 ? "" : "s", species, scenario.fields.size(),
             scenario.fields.size() == 1 ? "" : "s", options.xml_only ? ", whose data were not opened" : "");
  for (const fields::Field& field : fields.fields) fmt::print("  {}: {}\n", field.name, field.source);
}

}  // namespace silvasim::commands
