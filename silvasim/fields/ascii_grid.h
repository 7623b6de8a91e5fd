// A check that GDAL leaves out: it reads "abc" in an Arc/Info ASCII grid as 0 without a word.
#pragma once

#include <filesystem>
#include <string>

namespace silvasim::fields {

// The first word among the values that is no number, shortened; empty if all are. A decimal comma, nan, inf and null
// are numbers here, as they are for GDAL.
std::string wrong_word_in_ascii_grid(const std::filesystem::path& path);

}  // namespace silvasim::fields
