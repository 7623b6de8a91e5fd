// The container beneath the ecosystem file: a header, chunks one after another, their table, a footer. It knows nothing
// of plants. docs/ecosystem-file.md, "The container".
//
// Promise: every byte of a file belongs to one of these parts and is covered by a checksum.
// Errors: base::Error naming the file, the chunk and the byte.
// Threads: content() may be called from several.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "silvasim/ecosystem/source.h"

namespace silvasim::ecosystem {

inline constexpr std::uint16_t format_major = 1;  // readers refuse any other
inline constexpr std::uint16_t format_minor = 0;  // grows with chunks that older readers may skip

using ChunkType = std::array<char, 4>;

enum class Codec : std::uint8_t { raw = 0, zstd = 1 };

inline constexpr std::uint16_t flag_optional = 1;  // readers that do not know the type may skip the chunk
inline constexpr std::uint32_t no_layer = 0xFFFFFFFF;

// One entry of the chunk table.
struct Chunk {
  ChunkType type{};
  std::uint16_t flags = 0;
  Codec codec = Codec::zstd;
  std::uint32_t layer = no_layer;  // the vegetation layer it belongs to
  std::uint32_t first_row = 0;     // bands only: rows [first_row, first_row + rows)
  std::uint32_t rows = 0;          // 0: no band
  std::uint64_t offset = 0;        // of the stored bytes in the file
  std::uint64_t stored_size = 0;
  std::uint64_t content_size = 0;  // after decompression
  std::uint64_t checksum = 0;      // XXH3-64 of the stored bytes

  bool optional() const { return flags & flag_optional; }
};

// "chunk PLNT at byte 1234"
std::string name_of(const Chunk& chunk);

// What a file of `file_size` bytes may unfold to, so that a small file cannot fill the memory. A writer whose content
// is more uniform than this adds a chunk of zeros.
constexpr std::uint64_t most_content(std::uint64_t file_size) {
  return (std::uint64_t{64} << 20) + 1024 * std::min(file_size, std::uint64_t{1} << 50);
}

// Sets sizes and checksum of the chunk and returns the stored bytes.
std::vector<std::byte> pack(Chunk& chunk, std::span<const std::byte> content);

// The parts of a file in order: header, stored chunks, table and footer. Sets the chunks' offsets.
std::vector<std::byte> header_bytes();
std::vector<std::byte> table_and_footer_bytes(std::span<Chunk> chunks);
std::uint64_t file_size_of(std::span<const Chunk> chunks);

// An opened file whose header, table and footer are whole, whose chunks lie one after another without a gap, and whose
// chunks together claim no more than most_content().
class ChunkFile {
 public:
  explicit ChunkFile(const Source& source);

  const std::vector<Chunk>& chunks() const { return chunks_; }
  std::uint16_t minor() const { return minor_; }

  // Checks the checksum and unpacks into `content`, whose size must be chunk.content_size.
  void unpack(const Chunk& chunk, std::span<std::byte> content) const;
  std::vector<std::byte> content(const Chunk& chunk) const;
  // Checks the checksum only.
  void check(const Chunk& chunk) const;

  std::string where(const Chunk& chunk) const { return source_.name() + ": " + name_of(chunk); }
  [[noreturn]] void fail(const Chunk& chunk, const std::string& what) const;
  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::span<const std::byte> checked_bytes(const Chunk& chunk, std::vector<std::byte>& buffer) const;
  void read_table(std::span<const std::byte> header);

  const Source& source_;
  std::uint16_t minor_ = 0;
  std::vector<Chunk> chunks_;
};

}  // namespace silvasim::ecosystem
