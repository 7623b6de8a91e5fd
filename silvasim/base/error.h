// The errors that a user of Silva can mend. Programming errors are assertions, not these.
//
// Errors travel as exceptions to main(), the only place that prints one and ends the program.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "silvasim/base/place.h"

namespace silvasim::base {

// Something failed while running (a file could not be read, a disk is full). Exit code 1.
// The message is one line that names the thing and says what would have been right.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The user asked to stop (Ctrl-C, or a progress callback returned false). Exit code 130.
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled") {}
};

// One finding about a configuration.
struct Diagnostic {
  Place place;
  std::string message;

  friend bool operator==(const Diagnostic&, const Diagnostic&) = default;
};

// Wrong command line or configuration: all findings, in the order of the files. Exit code 2.
class ConfigError : public Error {
 public:
  explicit ConfigError(std::vector<Diagnostic> diagnostics);
  ConfigError(Place place, std::string message);

  const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

 private:
  std::vector<Diagnostic> diagnostics_;
};

// Appends a finding. After `most_diagnostics` there comes a last one, "... and more", so that a file of another kind can
// not flood the reader.
inline constexpr std::size_t most_diagnostics = 100;
void add(std::vector<Diagnostic>& diagnostics, Place place, std::string message);

// "file:line:column: error: message"
std::string to_string(const Diagnostic& diagnostic);

// The candidate closest to `word` by edit distance, as `; did you mean "..."?`; empty where none is close.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace silvasim::base
