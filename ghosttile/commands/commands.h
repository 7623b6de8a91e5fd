// The commands of ghosttile, one a file. Each takes its options as plain values, prints its result to standard output, and
// throws base::Error; main() maps errors to exit codes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "silvasim/terminal/terminal.h"

namespace ghosttile::commands {

using Path = std::filesystem::path;
using silvasim::terminal::Common;

struct CreateOptions {
  Common common;
  Path tile;
  std::optional<Path> output;  // default: the XML's name with .ghost in this folder
};

struct FillOptions {
  Common common;
  Path scene;
  std::optional<Path> output;  // default: the XML's name with .details in this folder
  std::vector<double> bbox;    // west, south, east, north
  std::vector<double> around;  // east, north
  double radius_m = 20;
};

struct EditOptions {
  Common common;
  Path details;
  std::optional<Path> strokes;
  bool undo = false;
  std::optional<Path> output;  // default: the file itself
  std::optional<Path> scene;   // default: the one that the file names
};

struct InfoOptions {
  Common common;
  Path file;
};

struct ExportOptions {
  Common common;
  Path details, output;
  std::string format;  // "" = by the output's extension
};

struct HelpOptions {
  std::string element;  // "" = all of them
  bool manual = false;
};

void create(const CreateOptions& options);
void fill(const FillOptions& options);
void edit(const EditOptions& options);
void info(const InfoOptions& options);
void export_details(const ExportOptions& options);
void schema();
void help(const HelpOptions& options);

}  // namespace ghosttile::commands
