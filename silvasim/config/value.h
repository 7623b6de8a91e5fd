// Words of the XML to typed values.
#pragma once

#include <string>

#include "silvasim/config/node.h"

namespace silvasim::config {

struct ParsedValue {
  Value value;
  std::string problem;  // empty when the text is right; else what is wrong and what would have been right
};

// `text` is trimmed. Numbers: a point as decimal mark, no trailing junk, no NaN or infinity, no overflow.
ParsedValue parse_value(const std::string& text, ValueType type, const std::vector<std::string>& choices, double least,
                        double most);

// "a length like 200 m", for messages and help.
std::string describe(ValueType type, const std::vector<std::string>& choices, double least, double most);

std::string trimmed(const std::string& text);

// Shortest text that reads back as the same number.
std::string to_text(double number);

}  // namespace silvasim::config
