#include "silvasim/ecosystem/compression.h"

#include <zstd.h>

#include "silvasim/base/error.h"

namespace silvasim::ecosystem {

namespace {

constexpr int level = 3;

}  // namespace

std::vector<std::byte> compress(std::span<const std::byte> content) {
  std::vector<std::byte> stored(ZSTD_compressBound(content.size()));
  const std::size_t size = ZSTD_compress(stored.data(), stored.size(), content.data(), content.size(), level);
  if (ZSTD_isError(size)) throw base::Error(std::string("cannot compress: ") + ZSTD_getErrorName(size));
  stored.resize(size);
  stored.shrink_to_fit();
  return stored;
}

std::string decompress(std::span<const std::byte> stored, std::span<std::byte> content) {
  // One frame and nothing after it, with the size that the chunk table announced.
  const std::size_t frame = ZSTD_findFrameCompressedSize(stored.data(), stored.size());
  if (ZSTD_isError(frame)) return std::string("it holds no zstd frame (") + ZSTD_getErrorName(frame) + ")";
  if (frame != stored.size()) {
    return "its zstd frame ends after " + std::to_string(frame) + " of " + std::to_string(stored.size()) + " bytes";
  }
  const unsigned long long claimed = ZSTD_getFrameContentSize(stored.data(), stored.size());
  if (claimed != content.size()) {
    return "its zstd frame claims " +
           (claimed == ZSTD_CONTENTSIZE_UNKNOWN ? std::string("no size") : std::to_string(claimed) + " bytes") +
           ", the chunk table " + std::to_string(content.size());
  }
  const std::size_t size = ZSTD_decompress(content.data(), content.size(), stored.data(), stored.size());
  if (ZSTD_isError(size)) return std::string("its zstd frame is damaged: ") + ZSTD_getErrorName(size);
  if (size != content.size()) return "its zstd frame holds " + std::to_string(size) + " bytes";
  return {};
}

}  // namespace silvasim::ecosystem
