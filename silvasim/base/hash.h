// Digests: SHA-256 for provenance (OpenSSL), XXH3 for checksums that only find damage (xxHash).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace silvasim::base {

std::string sha256_hex(std::span<const std::byte> bytes);
std::string sha256_hex(const std::string& text);
std::string sha256_of_file(const std::filesystem::path& path);  // Errors: base::Error if it cannot be read

std::uint64_t xxh3_64(std::span<const std::byte> bytes);

}  // namespace silvasim::base
