#include "silvasim/fields/ascii_grid.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <vector>

namespace silvasim::fields {

namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\0'; }

bool is_number(std::string word) {
  std::replace(word.begin(), word.end(), ',', '.');
  const char* const first = word.data() + (word.front() == '+' ? 1 : 0);
  const char* const last = word.data() + word.size();
  double value = 0;
  const auto [end, problem] = std::from_chars(first, last, value);
  if (end == last && problem != std::errc::invalid_argument) return true;  // too large for a double is still a number
  std::transform(word.begin(), word.end(), word.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  return word == "null" || word == "-1.#ind" || word == "1.#qnan";
}

bool is_header_name(const std::string& word) {
  const char c = word.front();
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

}  // namespace

std::string wrong_word_in_ascii_grid(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> buffer(1 << 20);
  constexpr std::size_t longest = 64;
  constexpr std::array header_pairs = {5, 6, 7};  // with or without nodata, cell size once or twice
  std::string word, wrong;
  // The header is pairs of a name and a value; it ends where a number stands in place of a name.
  int words = 0;
  bool in_header = true;
  const auto take = [&] {
    if (word.empty() || !wrong.empty()) return;
    if (in_header) {
      const bool name = words % 2 == 0;
      if (name && (!is_header_name(word) || words / 2 > header_pairs.back())) in_header = false;
      ++words;
    }
    if (!in_header && !is_number(word)) wrong = word;
    word.clear();
  };
  while (file && wrong.empty()) {
    file.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    const auto got = static_cast<std::size_t>(file.gcount());
    for (std::size_t i = 0; i < got; ++i) {
      if (is_space(buffer[i]))
        take();
      else if (word.size() < longest)
        word += buffer[i];
    }
  }
  take();
  return wrong;
}

}  // namespace silvasim::fields
