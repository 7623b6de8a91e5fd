// Columns as NumPy's .npy files (version 1.0, little-endian, row by row): what Blender's and anyone's Python reads at once.
//
// Errors: base::Error that names the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace silva_bench {

// `width`: numbers a row; 0: a column of plain numbers.
void write_npy(const std::filesystem::path& path, std::span<const float> values, std::size_t width = 0);
void write_npy(const std::filesystem::path& path, std::span<const std::uint16_t> values, std::size_t width = 0);

}  // namespace silva_bench
