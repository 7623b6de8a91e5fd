// The two XML files, and what they include, to a Scenario.
//
// Errors: base::ConfigError with every finding in both files; base::Error where a file cannot be read.
// Source: Silva 2013, sections 4.2.1 and 4.2.2; docs/dialect.md.
#pragma once

#include <filesystem>
#include <optional>

#include "silvasim/config/scenario.h"

namespace silvasim::config {

// `plants` overrides the ecosystem file's own word. The dialect must outlive the scenario.
Scenario load_scenario(const std::filesystem::path& ecosystem, const std::optional<std::filesystem::path>& plants,
                       const Dialect& dialect);

}  // namespace silvasim::config
