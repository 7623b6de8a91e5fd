#include "silvasim/commands/outputs.h"

#include <algorithm>
#include <system_error>

#include "silvasim/base/error.h"
#include "silvasim/base/file.h"
#include "silvasim/export/picture.h"

namespace silvasim::commands {

namespace {

// Files that GIS programs read together with a file of the same stem.
constexpr const char* companions[] = {".shp", ".shx", ".dbf", ".prj", ".cpg", ".qix", ".tfw", ".pgw",
                                      ".jgw", ".bpw", ".wld", ".hdr", ".ige", ".rrd", ".qpj"};
constexpr const char* appended[] = {".aux.xml", ".ovr", ".msk", "-wal", "-journal"};

std::vector<Path> with_companions(const std::vector<Path>& inputs) {
  std::vector<Path> all = inputs;
  std::error_code ignored;
  const auto add = [&](const Path& path) {
    if (std::filesystem::exists(path, ignored)) all.push_back(path);
  };
  for (const Path& input : inputs) {
    for (const char* const extension : companions) add(Path(input).replace_extension(extension));
    for (const char* const ending : appended) add(Path(input) += ending);
  }
  return all;
}

}  // namespace

std::vector<Path> files_of_output(const Path& output) {
  std::vector<Path> files{output};
  const std::vector<Path> beside = exports::files_beside(output);
  files.insert(files.end(), beside.begin(), beside.end());
  return files;
}

void check_outputs(const std::vector<Path>& outputs, const std::vector<Path>& inputs) {
  const std::vector<Path> read = with_companions(inputs);
  std::vector<Path> seen;
  for (const Path& output : outputs) {
    for (const Path& file : files_of_output(output)) {
      const Path name = std::filesystem::weakly_canonical(file);
      if (std::find(seen.begin(), seen.end(), name) != seen.end()) {
        terminal::wrong_option("two outputs have the name \"" + file.string() + "\"");
      }
      seen.push_back(name);
      base::NewFile probe(file, read);
    }
  }
}

}  // namespace silvasim::commands
