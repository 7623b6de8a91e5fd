// Where in a text file a thing was written, for messages of the form `file:line:column: error: ...`.
#pragma once

#include <string>

namespace silvasim::base {

struct Place {
  std::string file;  // as the user named it; empty: not from a file
  int line = 0;      // from 1; 0: unknown
  int column = 0;    // from 1; 0: unknown

  friend bool operator==(const Place&, const Place&) = default;
};

// "file:line:column", leaving out what is unknown.
std::string to_string(const Place& place);

}  // namespace silvasim::base
