#include "ghosttile/export/names.h"

#include "silvasim/base/words.h"

namespace ghosttile::exports {

namespace {

bool plain(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_'; }

}  // namespace

std::string word_of(std::string_view name) {
  std::string word = silvasim::base::printable(std::string(name));
  for (char& c : word) {
    const bool keep = plain(c) || c == '.' || c == '-' || static_cast<unsigned char>(c) >= 0x80;
    if (!keep) c = '_';
  }
  return word.empty() ? "_" : word;
}

std::string identifier_of(std::string_view name) {
  std::string word(name);
  for (char& c : word) {
    if (!plain(c)) c = '_';
  }
  return word.empty() || (word[0] >= '0' && word[0] <= '9') ? "_" + word : word;
}

}  // namespace ghosttile::exports
