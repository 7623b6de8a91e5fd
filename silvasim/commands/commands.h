// The commands of silvasim, one a file. Each takes its options as plain values, prints its result to standard output, and
// throws base::Error; main() maps errors to exit codes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "silvasim/terminal/terminal.h"

namespace silvasim::commands {

using Path = std::filesystem::path;

using terminal::Common;

struct ScenarioOptions {
  Path ecosystem;
  std::optional<Path> plants;
  std::optional<std::uint64_t> seed;  // overrides the file's
};

struct RunOptions {
  Common common;
  ScenarioOptions scenario;
  std::optional<Path> output;  // default: named after the ecosystem file or its folder, in the current folder
  std::optional<Path> svg, png;
  std::map<std::string, Path> exports;  // by format
  bool probabilities = false;
};

struct ValidateOptions {
  Common common;
  ScenarioOptions scenario;
  bool xml_only = false;  // leave the data alone
};

struct ExplainOptions {
  Common common;
  ScenarioOptions scenario;
  double x = 0, y = 0;
  bool degrees = false;  // x, y are longitude and latitude
};

struct InfoOptions {
  Common common;
  Path ecosystem;
};

struct PreviewOptions {
  Common common;
  Path ecosystem, output;
  std::string layer = "species";  // species | probability | suitability
  std::vector<std::string> species;
  std::vector<double> bbox;  // west, south, east, north
  int width_px = 1600;
  bool bare = false;
  std::string title;
};

struct ExportOptions {
  Common common;
  Path ecosystem, output;
  std::string format;  // "" = by the output's extension
};

struct HelpOptions {
  std::string element;  // "" = all of them
  bool manual = false;
};

void run(const RunOptions& options);
void validate(const ValidateOptions& options);
void explain_point(const ExplainOptions& options);
void info(const InfoOptions& options);
void preview(const PreviewOptions& options);
void export_plants(const ExportOptions& options);
void schema();
void help(const HelpOptions& options);

}  // namespace silvasim::commands
