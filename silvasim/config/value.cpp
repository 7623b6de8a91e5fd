#include "silvasim/config/value.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include "silvasim/base/error.h"

namespace silvasim::config {

namespace {

struct Unit {
  const char* name;
  double factor;
};

constexpr Unit length_units[] = {{"m", 1}, {"km", 1000}, {"cm", 0.01}, {"mm", 0.001}, {"ft", 0.3048}};
constexpr Unit fraction_units[] = {{"%", 0.01}};
constexpr Unit angle_units[] = {{"deg", 1}};
constexpr Unit duration_units[] = {{"s", 1}, {"min", 60}, {"ms", 0.001}};

std::string quoted(const std::string& text) {
  constexpr std::size_t most_shown = 80;
  return "\"" + (text.size() > most_shown ? text.substr(0, most_shown) + "..." : text) + "\"";
}

// Splits "0.2 km" into 0.2 and "km". Returns a problem, or "".
std::string split_number(const std::string& text, double& number, std::string& unit) {
  const char* first = text.data();
  const char* last = first + text.size();
  const auto [end, error] = std::from_chars(first, last, number);
  if (error == std::errc::result_out_of_range) return quoted(text) + " is too large or too small for a number";
  if (error != std::errc{} || end == first) {
    return text.empty() ? "a number is missing" : quoted(text) + " is no number";
  }
  if (!std::isfinite(number)) return quoted(text) + " is no finite number";
  unit = trimmed(std::string(end, last));
  if (!unit.empty() && unit[0] == ',') return quoted(text) + " has a comma; the decimal mark is a point";
  return {};
}

template <std::size_t count>
std::string apply_unit(const std::string& text, const Unit (&units)[count], double& number, const std::string& unit) {
  if (unit.empty()) return {};
  std::string known;
  for (const Unit& u : units) {
    if (unit == u.name) {
      number *= u.factor;
      return {};
    }
    known += (known.empty() ? "" : ", ") + std::string(u.name);
  }
  return quoted(text) + " has the unknown unit " + quoted(unit) + "; known are " + known;
}

std::string check_range(const std::string& text, double number, double least, double most) {
  if (number < least && least > 0 && least < 1e-6) return quoted(text) + " is not above 0";
  if (number < least) return quoted(text) + " is below the least allowed, " + to_text(least);
  if (number > most) return quoted(text) + " is above the most allowed, " + to_text(most);
  return {};
}

ParsedValue parse_number(const std::string& text, ValueType type, double least, double most) {
  double number = 0;
  std::string unit;
  std::string problem = split_number(text, number, unit);
  if (problem.empty()) {
    if (type == ValueType::length) {
      problem = apply_unit(text, length_units, number, unit);
    } else if (type == ValueType::fraction) {
      problem = apply_unit(text, fraction_units, number, unit);
    } else if (type == ValueType::angle) {
      problem = apply_unit(text, angle_units, number, unit);
    } else if (type == ValueType::duration) {
      problem = apply_unit(text, duration_units, number, unit);
    } else if (!unit.empty()) {
      problem = quoted(text) + " has " + quoted(unit) +
                " after the number; it takes a plain number in the unit of its data field";
    }
  }
  if (problem.empty() && type == ValueType::integer && number != std::floor(number)) {
    problem = quoted(text) + " is no whole number";
  }
  if (problem.empty()) problem = check_range(text, number, least, most);
  return {number, problem};
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

ParsedValue parse_colour(const std::string& text) {
  double number = 0;
  bool good = text.size() == 7 && text[0] == '#';
  for (std::size_t i = 1; good && i < 7; ++i) {
    good = hex_digit(text[i]) >= 0;
    number = number * 16 + hex_digit(text[i]);
  }
  if (good) return {number, ""};
  return {Value{}, quoted(text) + " is no colour; write it like #1f5f3a"};
}

}  // namespace

std::string trimmed(const std::string& text) {
  constexpr const char* blank = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blank);
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

std::string to_text(double number) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, number);
  return std::string(buffer, result.ptr);
}

ParsedValue parse_value(const std::string& text, ValueType type, const std::vector<std::string>& choices, double least,
                        double most) {
  switch (type) {
    case ValueType::none:
      return {Value{}, text.empty() ? "" : "unexpected text " + quoted(text)};
    case ValueType::text:
      return {text, ""};
    case ValueType::name:
    case ValueType::path:
      return {text, text.empty() ? "must not be empty" : ""};
    case ValueType::number:
    case ValueType::integer:
    case ValueType::length:
    case ValueType::angle:
    case ValueType::duration:
      return parse_number(text, type, least, most);
    case ValueType::fraction:
      return parse_number(text, type, std::max(least, 0.0), std::min(most, 1.0));
    case ValueType::boolean:
      if (text == "true" || text == "1") return {true, ""};
      if (text == "false" || text == "0") return {false, ""};
      return {Value{}, quoted(text) + " is neither true nor false"};
    case ValueType::colour:
      return parse_colour(text);
    case ValueType::choice:
      for (const std::string& choice : choices) {
        if (text == choice) return {text, ""};
      }
      return {Value{},
              quoted(text) + " is none of " + describe(type, choices, least, most) + base::did_you_mean(text, choices)};
  }
  return {};
}

std::string describe(ValueType type, const std::vector<std::string>& choices, double least, double most) {
  std::string range;
  const bool positive = least > 0 && least < 1e-6;
  if (positive) {
    range = ", above 0" + (std::isfinite(most) ? ", at most " + to_text(most) : std::string());
  } else if (std::isfinite(least) && std::isfinite(most)) {
    range = ", " + to_text(least) + " to " + to_text(most);
  } else if (std::isfinite(least)) {
    range = ", at least " + to_text(least);
  } else if (std::isfinite(most)) {
    range = ", at most " + to_text(most);
  }
  switch (type) {
    case ValueType::none:
      return "nothing";
    case ValueType::text:
      return "text";
    case ValueType::name:
      return "a name";
    case ValueType::path:
      return "a file, relative to this one";
    case ValueType::number:
      return "a number" + range;
    case ValueType::integer:
      return "a whole number" + range;
    case ValueType::boolean:
      return "true or false";
    case ValueType::fraction:
      return "a share from 0 to 1, or a percentage";
    case ValueType::length:
      return "a length in metres, or with m, km, cm, mm, ft" + range;
    case ValueType::angle:
      return "an angle in degrees" + range;
    case ValueType::duration:
      return "a time in seconds, or with s, min, ms" + range;
    case ValueType::colour:
      return "a colour like #1f5f3a";
    case ValueType::choice: {
      std::string words;
      for (const std::string& choice : choices) words += (words.empty() ? "" : ", ") + choice;
      return words;
    }
  }
  return {};
}

}  // namespace silvasim::config
