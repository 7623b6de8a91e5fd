// ghosttile export: details for other programs.
#include <fmt/format.h>

#include <system_error>

#include "ghosttile/commands/commands.h"
#include "ghosttile/commands/console.h"
#include "ghosttile/export/formats.h"
#include "ghosttile/fill/file.h"

namespace ghosttile::commands {

void export_details(const ExportOptions& options) {
  const silvasim::base::Progress progress = silvasim::terminal::console_progress(options.common);
  const exports::Format& format = exports::format_for(options.format, options.output);
  const fill::DetailsFile file = fill::read(options.details);
  const std::vector<Path> inputs = {options.details};
  exports::WriteOptions writing;
  writing.inputs = inputs;
  writing.crs_wkt = file.crs_wkt;
  writing.progress = progress;
  format.write(file, options.output, writing);
  silvasim::terminal::end_progress(options.common);
  std::error_code ignored;
  const auto bytes = std::filesystem::file_size(options.output, ignored);
  if (options.common.json) {
    const Json json = {{"format", format.name},
                       {"instances", file.details.count()},
                       {"bytes", bytes},
                       {"output", options.output.string()}};
    fmt::print("{}\n", json.dump(2));
  } else if (!options.common.quiet) {
    fmt::print("{} instances written to {}, {}\n", silvasim::terminal::grouped(file.details.count()),
               options.output.string(), silvasim::terminal::bytes_text(bytes));
  }
}

}  // namespace ghosttile::commands
