// silvasim schema and silvasim help: the dialect for editors and for people.
#include <fmt/format.h>

#include "silvasim/base/error.h"
#include "silvasim/commands/commands.h"
#include "silvasim/config/help.h"
#include "silvasim/config/schema.h"
#include "silvasim/evaluators/evaluator.h"

namespace silvasim::commands {

void schema() { fmt::print("{}", config::xml_schema(evaluators::dialect())); }

void help(const HelpOptions& options) {
  const config::Dialect& dialect = evaluators::dialect();
  if (options.manual) {
    fmt::print("{}", config::help_manual(dialect));
  } else if (options.element.empty()) {
    fmt::print("{}", config::help_overview(dialect));
  } else {
    const std::string text = config::help_element(dialect, options.element);
    if (text.empty()) {
      terminal::wrong_option("there is no element <" + options.element + ">" +
                             base::did_you_mean(options.element, config::element_names(dialect)));
    }
    fmt::print("{}", text);
  }
}

}  // namespace silvasim::commands
