// What the programs share in talking to a person or a program: progress, and figures made readable.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "silvasim/base/error.h"
#include "silvasim/base/progress.h"

namespace silvasim::terminal {

// Options that most commands have.
struct Common {
  bool json = false;
  bool quiet = false;
  int threads = 0;  // 0: one a core
};

// Runs a program's commands, which give the exit code: the only place that prints an error. 0 done, 1 failed while running, 2 wrong
// command line or configuration, 130 interrupted. `program`: its name; `less`: what takes less memory.
int run(const std::string& program, const std::string& less, const std::function<int()>& commands);

// A command line that names no command, or options that it has not.
class UsageError : public base::Error {
 public:
  using Error::Error;
};
// An option that does not go with the others, or with what it is for.
[[noreturn]] void wrong_option(const std::string& message);

// Progress on standard error: a bar on a terminal, a line a stage elsewhere, nothing when quiet.
base::Progress console_progress(const Common& common);

// Removes the bar, so that what follows starts on a clean line.
void end_progress(const Common& common);

// "1,234,567"
std::string grouped(std::uint64_t number);
// "12.3 MB"
std::string bytes_text(std::uint64_t bytes);

}  // namespace silvasim::terminal
