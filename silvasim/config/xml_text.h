// What the XML library lets pass and a careful reader must not: encodings, entities and characters.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "silvasim/base/error.h"

namespace silvasim::config {

// The first thing that is wrong with the text as XML characters, or nothing.
std::optional<base::Diagnostic> check_xml_text(const std::string& text, const std::string& file);

// Finds columns, which the XML library does not report. Elements must be asked for in document order.
class ColumnFinder {
 public:
  explicit ColumnFinder(const std::string& text);

  // Column of `<tag` in the line, from 1; 0 where it is not found.
  int element(int line, const std::string& tag);

  // Column of the attribute in the line, at or after `from_column`.
  int attribute(int line, const std::string& name, int from_column) const;

 private:
  std::string_view line_text(int line) const;

  const std::string& text_;
  std::vector<std::size_t> starts_;
  int last_line_ = 0;
  std::size_t searched_ = 0;  // up to where in the last line elements were found already
};

}  // namespace silvasim::config
