// ghosttile schema and help: the grammar of its XML files.
#include "ghosttile/config/dialect.h"

#include <fmt/format.h>

#include "ghosttile/commands/commands.h"
#include "silvasim/base/error.h"
#include "silvasim/config/help.h"
#include "silvasim/config/schema.h"

namespace ghosttile::commands {

void schema() { fmt::print("{}", silvasim::config::xml_schema(config::dialect())); }

void help(const HelpOptions& options) {
  if (options.manual) {
    fmt::print("{}", silvasim::config::help_manual(config::dialect()));
    return;
  }
  if (options.element.empty()) {
    fmt::print("{}", silvasim::config::help_overview(config::dialect()));
    return;
  }
  const std::string text = silvasim::config::help_element(config::dialect(), options.element);
  if (text.empty())
    silvasim::terminal::wrong_option(
        "there is no element \"" + options.element + "\"" +
        silvasim::base::did_you_mean(options.element, silvasim::config::element_names(config::dialect())));
  fmt::print("{}", text);
}

}  // namespace ghosttile::commands
