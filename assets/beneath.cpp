#include "assets/beneath.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <system_error>

namespace assets {

namespace fs = std::filesystem;

namespace {

bool has_scheme(const std::string& name) {
  const std::size_t colon = name.find(':');
  if (colon == std::string::npos || colon == 0) return false;
  return std::all_of(name.begin(), name.begin() + static_cast<std::ptrdiff_t>(colon),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '+' || c == '-' || c == '.'; });
}

bool lies_in(const fs::path& file, const fs::path& folder) {
  const auto [f, d] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return f == folder.end() && d != file.end();
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

Beneath file_beneath(const fs::path& folder, const std::string& name) {
  if (name.empty()) return {{}, "is an empty name"};
  if (name.size() > 1024) return {{}, "is too long a name"};
  if (std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; })) {
    return {{}, "is no file name"};
  }
  std::string slashed = name;
  std::replace(slashed.begin(), slashed.end(), '\\', '/');
  if (has_scheme(slashed)) return {{}, "is refused: a URL or a drive, not a file in the model's folder"};
  const fs::path relative(slashed);
  if (relative.is_absolute()) return {{}, "is refused: an absolute path; put the file into the model's folder"};
  for (const fs::path& part : relative) {
    if (part == "..") return {{}, "is refused: \"..\" leaves the model's folder; put the file into it"};
  }
  if (slashed.find_first_of("<>") != std::string::npos || slashed.find("%(") != std::string::npos) {
    return {{}, "is refused: a pattern of several files is not supported"};
  }

  std::error_code error;
  const fs::path root = fs::canonical(folder.empty() ? fs::path(".") : folder, error);
  if (error) return {{}, "is missing"};
  const fs::path file = fs::canonical(root / relative, error);
  if (error) return {{}, "is missing"};
  if (!lies_in(file, root)) return {{}, "is refused: a link that leads out of the model's folder"};
  if (!fs::is_regular_file(file, error) || error) return {{}, "is no regular file"};
  return {file, {}};
}

std::string percent_decoded(const std::string& uri) {
  std::string text;
  text.reserve(uri.size());
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size()) {
      const int high = hex_digit(uri[i + 1]), low = hex_digit(uri[i + 2]);
      if (high >= 0 && low >= 0) {
        text += static_cast<char>(high * 16 + low);
        i += 2;
        continue;
      }
    }
    text += uri[i];
  }
  return text;
}

}  // namespace assets
