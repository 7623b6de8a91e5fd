// What the programs share in talking to a person or a program: progress, and figures made readable.
#pragma once

#include <cstdint>
#include <string>

#include "silvasim/base/progress.h"

namespace silvasim::terminal {

// Options that most commands have.
struct Common {
  bool json = false;
  bool quiet = false;
  int threads = 0;  // 0: one a core
};

// Progress on standard error: a bar on a terminal, a line a stage elsewhere, nothing when quiet.
base::Progress console_progress(const Common& common);

// Removes the bar, so that what follows starts on a clean line.
void end_progress(const Common& common);

// "1,234,567"
std::string grouped(std::uint64_t number);
// "12.3 MB"
std::string bytes_text(std::uint64_t bytes);

}  // namespace silvasim::terminal
