#include "silvasim/base/words.h"

#include <algorithm>

namespace silvasim::base {

std::size_t character_length(const std::string& text, std::size_t i) {
  const auto byte = [&](std::size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0u; };
  const unsigned first = byte(i);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : first >= 0xC0 ? 2 : 0;
  if (length == 0 || first > 0xF4) return 0;
  unsigned code = first & (0xFFu >> (length + 1));
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(i + k) & 0xC0) != 0x80) return 0;
    code = code << 6 | (byte(i + k) & 0x3F);
  }
  const unsigned least = length == 2 ? 0x80 : length == 3 ? 0x800 : 0x10000;
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  const bool no_character = (code & 0xFFFE) == 0xFFFE || code > 0x10FFFF;  // XML forbids U+FFFE and U+FFFF
  return code < least || surrogate || no_character ? 0 : length;
}

std::string printable(const std::string& text) {
  std::string clean;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = character_length(text, i);
    const auto first = static_cast<unsigned char>(text[i]);
    // The second set of control characters, U+0080 to U+009F, has a terminal's escape codes in one character.
    const bool second_set = length == 2 && first == 0xC2 && static_cast<unsigned char>(text[i + 1]) < 0xA0;
    if (length == 1 && (first == '\n' || first == '\r' || first == '\t')) {
      clean += ' ';
    } else if (length == 0 || first < 0x20 || first == 0x7F || second_set) {
      clean += "\uFFFD";
    } else {
      clean.append(text, i, length);
    }
    i += std::max<std::size_t>(1, length);
  }
  return clean;
}

std::string shortened(const std::string& text, std::size_t most) {
  const std::string clean = printable(text);
  std::size_t end = 0;
  for (std::size_t count = 0; count < most && end < clean.size(); ++count) end += character_length(clean, end);
  return end == clean.size() ? clean : clean.substr(0, end) + "...";
}

}  // namespace silvasim::base
