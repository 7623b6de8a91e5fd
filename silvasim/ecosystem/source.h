// Where a file's bytes come from: memory, or a file on disk that is read piece by piece.
//
// Errors: base::Error naming the file when it is missing, no regular file, or cut off meanwhile.
// Threads: fetch() may be called from several.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace silvasim::ecosystem {

class Source {
 public:
  virtual ~Source() = default;
  virtual const std::string& name() const = 0;
  virtual std::uint64_t size() const = 0;
  // offset + size <= this->size(). The answer may lie in `buffer`.
  virtual std::span<const std::byte> fetch(std::uint64_t offset, std::uint64_t size,
                                           std::vector<std::byte>& buffer) const = 0;
};

std::unique_ptr<Source> source_from_memory(std::span<const std::byte> bytes, std::string name);
std::unique_ptr<Source> source_from_file(const std::filesystem::path& path);

}  // namespace silvasim::ecosystem
