// What the XML library lets pass or words badly, and a careful reader must not: whether a text is well-formed XML 1.0, and
// where its elements and attributes stand.
//
// Promise: what passes is taken by any XML parser. Besides, no document type declaration (and so no entity of one's own),
// no encoding but UTF-8, at most `most_depth` levels, `most_elements` elements and `most_attributes` attributes each, for
// the library needs time in the square of those.
// Cost: linear in the text.
#pragma once

#include <string>
#include <vector>

#include "silvasim/base/error.h"

namespace silvasim::config {

inline constexpr std::size_t most_depth = 100, most_elements = 1'000'000, most_attributes = 100;

struct TextPlace {
  int line = 1, column = 1;  // in bytes, from 1
};

// In the order of the document.
struct XmlPlaces {
  struct Element {
    TextPlace at;
    std::size_t first_attribute = 0;  // index into `attributes`
  };
  std::vector<Element> elements;
  std::vector<TextPlace> attributes;
};

// Errors: base::ConfigError with the first thing that is wrong. A text without any element passes.
XmlPlaces scan_xml(const std::string& text, const std::string& file);

}  // namespace silvasim::config
