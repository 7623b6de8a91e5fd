// Texts from files and users, made fit to be shown.
#pragma once

#include <cstddef>
#include <string>

namespace silvasim::base {

// Length of the UTF-8 character at byte `i`, or 0 where the bytes are none (overlong, surrogate, out of range, cut).
std::size_t character_length(const std::string& text, std::size_t i);

// Valid UTF-8 in one line, without control characters, which could command a terminal: they and what is no UTF-8 become
// U+FFFD, line ends and tabs become spaces.
std::string printable(const std::string& text);

// Printable, and with more than `most` characters its beginning and "...".
std::string shortened(const std::string& text, std::size_t most);

}  // namespace silvasim::base
