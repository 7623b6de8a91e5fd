// XML text to checked nodes. Everything the dialect does not know is an error, and all errors of a file are gathered.
//
// Hostile input: files over 16 MB, other encodings than UTF-8, document type declarations (and so entities of one's own),
// second roots, control characters and more than 100 levels end in one clear error. Nothing is fetched or expanded.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "silvasim/base/error.h"
#include "silvasim/config/node.h"

namespace silvasim::config {

inline constexpr std::size_t most_config_bytes = 16u << 20;

// `file` stands in messages. The root must be the element of type `root`. Nothing is returned where the text is no XML or
// has another root; otherwise what could be read, with the errors appended to `errors`.
std::optional<Node> parse_xml(const std::string& text, const std::string& file, const Dialect& dialect,
                              const std::string& root, std::vector<base::Diagnostic>& errors);

}  // namespace silvasim::config
