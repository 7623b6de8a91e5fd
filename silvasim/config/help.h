// The dialect in words, for `silvasim help` and for docs/dialect.md: the same tables as the parser's.
#pragma once

#include <string>
#include <vector>

#include "silvasim/config/rules.h"

namespace silvasim::config {

// All elements, each with its first sentence.
std::string help_overview(const Dialect& dialect);

// One element, by tag or type; elements that share a tag follow one another. Empty where there is none.
std::string help_element(const Dialect& dialect, const std::string& name);

// The manual page of the whole dialect, as Markdown.
std::string help_manual(const Dialect& dialect);

std::vector<std::string> element_names(const Dialect& dialect);

}  // namespace silvasim::config
