#include "assets/obj_lines.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "silvasim/base/words.h"

namespace assets {

namespace {

constexpr std::size_t most_corners = 65536;
constexpr std::size_t most_libraries = 64;

bool digit(char c) { return c >= '0' && c <= '9'; }

// Length of the decimal number at the start: "-1", "2.", ".5", "+3e-2". 0: none.
std::size_t number_length(const std::string& word) {
  std::size_t i = 0, digits = 0;
  if (i < word.size() && (word[i] == '+' || word[i] == '-')) ++i;
  for (; i < word.size() && digit(word[i]); ++i) ++digits;
  if (i < word.size() && word[i] == '.') ++i;
  for (; i < word.size() && digit(word[i]); ++i) ++digits;
  if (digits == 0) return 0;
  if (i < word.size() && (word[i] == 'e' || word[i] == 'E')) {
    std::size_t j = i + 1;
    if (j < word.size() && (word[j] == '+' || word[j] == '-')) ++j;
    if (j < word.size() && digit(word[j])) {
      while (j < word.size() && digit(word[j])) ++j;
      i = j;
    }
  }
  return i;
}

float number(const std::string& word) {
  float value = 0;
  const std::size_t start = word[0] == '+' ? 1 : 0;
  std::from_chars(word.data() + start, word.data() + word.size(), value);
  return std::isfinite(value) ? value : 0.0f;
}

// "1", "1/2", "1//3", "1/2/3"; each may be negative, none 0.
bool is_corner(const std::string& word) {
  std::size_t i = 0;
  for (int part = 0; part < 3; ++part) {
    const bool empty = i < word.size() && word[i] == '/';
    if (!(part == 1 && empty)) {
      if (i < word.size() && word[i] == '-') ++i;
      int value = 0;
      const auto [end, error] = std::from_chars(word.data() + i, word.data() + word.size(), value);
      if (error != std::errc{} || value <= 0) return false;
      i = static_cast<std::size_t>(end - word.data());
    }
    if (i == word.size()) return true;
    if (word[i] != '/' || part == 2) return false;
    ++i;
  }
  return false;
}

void split(const std::string& line, std::vector<std::string>& words) {
  words.clear();
  std::size_t i = 0;
  while (true) {
    i = line.find_first_not_of(" \t", i);
    if (i == std::string::npos) return;
    const std::size_t end = std::min(line.find_first_of(" \t", i), line.size());
    words.push_back(line.substr(i, end - i));
    i = end;
  }
}

}  // namespace

ObjLines::int_type ObjLines::underflow() {
  while (error_.empty() && next_statement()) {
    if (!accept()) continue;
    if (!error_.empty()) break;
    statement_ += '\n';
    setg(statement_.data(), statement_.data(), statement_.data() + statement_.size());
    return traits_type::to_int_type(*gptr());
  }
  return traits_type::eof();
}

// The next line that is not empty, with its continuations and without comment.
bool ObjLines::next_statement() {
  while (at_ < text_.size()) {
    statement_.clear();
    line_ = next_line_;
    bool continued = true;
    while (continued && at_ < text_.size()) {
      const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
      statement_.append(text_, at_, end - at_);
      at_ = end;
      if (at_ < text_.size()) at_ += text_.compare(at_, 2, "\r\n") == 0 ? 2 : 1;
      ++next_line_;
      continued = !statement_.empty() && statement_.back() == '\\';
      if (continued) statement_.back() = ' ';
    }
    statement_.erase(std::min(statement_.find('#'), statement_.size()));
    std::replace(statement_.begin(), statement_.end(), '\0', '?');
    const std::size_t last = statement_.find_last_not_of(" \t");
    statement_.erase(last == std::string::npos ? 0 : last + 1);
    if (!statement_.empty()) return true;
  }
  return false;
}

bool ObjLines::accept() {
  split(statement_, words_);
  const std::string& kind = words_.front();
  if (kind == "v") {
    if (check_numbers(3, 8) && (words_.size() == 7 || !colours_.empty())) {
      colours_.resize(vertices_, Rgb(1.0f, 1.0f, 1.0f));
      const bool coloured = words_.size() == 7;
      colours_.push_back(coloured ? Rgb(number(words_[4]), number(words_[5]), number(words_[6]))
                                  : Rgb(1.0f, 1.0f, 1.0f));
    }
    ++vertices_;
    return true;
  }
  if (kind == "vn") {
    check_numbers(3, 3);
    return true;
  }
  if (kind == "vt") {
    check_numbers(1, 3);
    return true;
  }
  if (kind == "f" || kind == "fo") {
    if (check_corners() && kind == "fo") statement_.replace(statement_.find("fo"), 2, "f");
    return true;
  }
  if (kind == "usemtl") return words_.size() > 1;
  if (kind == "mtllib" && words_.size() > 1 && libraries_.size() < most_libraries) {
    libraries_.push_back(statement_.substr(statement_.find(words_[1], statement_.find("mtllib") + 6)));
  }
  if (kind == "s") flat_ = words_.size() > 1 && (words_[1] == "off" || words_[1] == "0");
  if (kind == "curv" || kind == "curv2" || kind == "surf") other_surfaces_ = true;
  return false;
}

bool ObjLines::check_numbers(std::size_t least, std::size_t most) {
  const std::size_t count = words_.size() - 1;
  if (count < least || count > most) {
    error_ = "\"" + words_[0] + "\" needs " + std::to_string(least) + " numbers" + (most > least ? " or more" : "") +
             ", here are " + std::to_string(count);
    return false;
  }
  for (std::size_t i = 1; i < words_.size(); ++i) {
    const std::size_t length = number_length(words_[i]);
    if (length == 0) {
      error_ = "\"" + silvasim::base::shortened(words_[i], 40) + "\" is no number";
      return false;
    }
    if (length < words_[i].size() && odd_number_.empty()) {
      odd_number_ = words_[i];
      odd_number_line_ = line_;
    }
  }
  return true;
}

bool ObjLines::check_corners() {
  if (words_.size() - 1 > most_corners) {
    error_ = "a face has more than " + std::to_string(most_corners) + " corners";
    return false;
  }
  for (std::size_t i = 1; i < words_.size(); ++i) {
    if (!is_corner(words_[i])) {
      error_ = "\"" + silvasim::base::shortened(words_[i], 40) +
               "\" is no corner of a face; it should be like 1, 1/2, 1//3 or 1/2/3, counted from 1";
      return false;
    }
  }
  return true;
}

}  // namespace assets
