// silvasim preview and silvasim export: an ecosystem file for people and for other programs.
#include "silvasim/export/picture.h"

#include <fmt/format.h>

#include "silvasim/base/error.h"
#include "silvasim/base/parallel.h"
#include "silvasim/commands/commands.h"
#include "silvasim/commands/console.h"
#include "silvasim/commands/outputs.h"
#include "silvasim/ecosystem/file.h"
#include "silvasim/export/formats.h"

namespace silvasim::commands {

void preview(const PreviewOptions& options) {
  const base::ThreadLimit limit(options.common.threads);
  exports::PreviewOptions picture;
  picture.width_px = options.width_px;
  picture.species = options.species;
  if (options.layer == "probability") picture.subject = exports::Subject::probability;
  if (options.layer == "suitability") picture.subject = exports::Subject::suitability;
  picture.decorated = !options.bare;
  picture.title = options.title;
  if (!options.bbox.empty())
    picture.bbox = base::Box{options.bbox[0], options.bbox[1], options.bbox[2], options.bbox[3]};
  check_outputs({options.output}, {options.ecosystem});
  const base::Progress progress = console_progress(options.common);
  const ecosystem::Ecosystem grown = ecosystem::read(options.ecosystem, progress);
  exports::write_preview(grown, picture, options.output);
  end_progress(options.common);
  if (!options.common.quiet)
    fmt::print("wrote    {} ({})\n", options.output.string(), bytes_text(std::filesystem::file_size(options.output)));
}

void export_plants(const ExportOptions& options) {
  const base::ThreadLimit limit(options.common.threads);
  check_outputs({options.output}, {options.ecosystem});
  const base::Progress progress = console_progress(options.common);
  const ecosystem::Ecosystem grown = ecosystem::read(options.ecosystem, progress);
  exports::export_to(grown, options.format, options.output, progress);
  end_progress(options.common);
  if (!options.common.quiet)
    fmt::print("wrote    {} ({})\n", options.output.string(), bytes_text(std::filesystem::file_size(options.output)));
}

}  // namespace silvasim::commands
