// silvavis diff: how much two pictures differ.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace silvavis::commands {

struct DiffOptions {
  std::filesystem::path a, b;
  std::vector<std::string> metrics;  // names as they are printed, e.g. "rmse"; empty: all
  double threshold = 0.01;           // a pixel differs where a channel does by more
  std::optional<double> at_most;     // with one metric: more than this is an error (of a similarity: less)
  bool json = false;
};

// Prints to standard output. EXR files are also compared by what else they hold of each pixel: depth_..., normal_...,
// species_..., plant_..., where both hold it. A number that there is none of (PSNR of equal pictures) is null in JSON.
// Errors: base::Error for files that cannot be read or differ in size, an unknown metric, and a limit that is exceeded.
void diff(const DiffOptions& options);

// The text that diff() prints.
std::string diff_text(const DiffOptions& options);

}  // namespace silvavis::commands
