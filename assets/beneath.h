// Which file a model may name: one in its own folder or below it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace assets {

struct Beneath {
  std::filesystem::path file;  // empty: refused or missing
  std::string refusal;         // then why, to follow the name: "is missing", "is a URL", ...
};

// Refused: absolute paths, drives, URLs, "..", names that libraries expand to several files (<UDIM>), what is no regular
// file, and links that lead out of `folder`. Backslashes count as slashes, because many models were made on Windows.
Beneath file_beneath(const std::filesystem::path& folder, const std::string& name);

// "leaf%20a.png" -> "leaf a.png"
std::string percent_decoded(const std::string& uri);

}  // namespace assets
