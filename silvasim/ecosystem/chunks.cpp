#include "silvasim/ecosystem/chunks.h"

#include <algorithm>

#include "silvasim/base/hash.h"
#include "silvasim/ecosystem/bytes.h"
#include "silvasim/ecosystem/compression.h"

namespace silvasim::ecosystem {

namespace {

// The first byte is no ASCII, and the line ends show whether a transfer "mended" them.
constexpr std::array<unsigned char, 8> magic{0x89, 'S', 'I', 'L', 'V', 'A', '\r', '\n'};
constexpr std::array<unsigned char, 8> end_magic{'S', 'I', 'L', 'V', 'A', 'E', 'N', 'D'};
constexpr std::uint32_t endian_tag = 0x01020304;

constexpr std::uint64_t header_size = 24, entry_size = 56, footer_size = 40;
constexpr std::uint64_t hashed_of_header = 16, hashed_of_footer = 24;

bool equal(std::span<const std::byte> bytes, const std::array<unsigned char, 8>& to) {
  return std::ranges::equal(bytes, std::as_bytes(std::span(to)));
}

// Header, table and the footer up to its hash. The table holds the checksums of the chunks, so this covers every byte.
std::uint64_t file_hash(std::span<const std::byte> header, std::span<const std::byte> table,
                        std::span<const std::byte> footer) {
  ByteWriter all;
  all.put_raw(header);
  all.put_raw(table);
  all.put_raw(footer.first(hashed_of_footer));
  return base::xxh3_64(all.take());
}

void put_entry(ByteWriter& to, const Chunk& chunk) {
  to.put_raw(std::as_bytes(std::span(chunk.type)));
  to.put(chunk.flags);
  to.put(static_cast<std::uint8_t>(chunk.codec));
  to.put(std::uint8_t{0});
  to.put(chunk.layer);
  to.put(chunk.first_row);
  to.put(chunk.rows);
  to.put(std::uint32_t{0});
  to.put(chunk.offset);
  to.put(chunk.stored_size);
  to.put(chunk.content_size);
  to.put(chunk.checksum);
}

// Fields that must be zero are kept for later versions; one that is not zero means something this reader does not know.
bool get_entry(ByteReader& from, Chunk& chunk) {
  for (char& c : chunk.type) c = static_cast<char>(from.get<std::uint8_t>());
  chunk.flags = from.get<std::uint16_t>();
  chunk.codec = static_cast<Codec>(from.get<std::uint8_t>());
  const bool first_is_zero = from.get<std::uint8_t>() == 0;
  chunk.layer = from.get<std::uint32_t>();
  chunk.first_row = from.get<std::uint32_t>();
  chunk.rows = from.get<std::uint32_t>();
  const bool second_is_zero = from.get<std::uint32_t>() == 0;
  chunk.offset = from.get<std::uint64_t>();
  chunk.stored_size = from.get<std::uint64_t>();
  chunk.content_size = from.get<std::uint64_t>();
  chunk.checksum = from.get<std::uint64_t>();
  return first_is_zero && second_is_zero;
}

std::string version(std::uint16_t major, std::uint16_t minor) {
  return std::to_string(major) + "." + std::to_string(minor);
}

}  // namespace

std::string name_of(const Chunk& chunk) {
  std::string type;
  for (const char c : chunk.type) type += c >= ' ' && c <= '~' ? c : '?';
  return "chunk " + type + " at byte " + std::to_string(chunk.offset);
}

std::vector<std::byte> pack(Chunk& chunk, std::span<const std::byte> content) {
  std::vector<std::byte> stored =
      chunk.codec == Codec::zstd ? compress(content) : Bytes(content.begin(), content.end());
  chunk.stored_size = stored.size();
  chunk.content_size = content.size();
  chunk.checksum = base::xxh3_64(stored);
  return stored;
}

std::vector<std::byte> header_bytes() {
  ByteWriter header;
  header.put_raw(std::as_bytes(std::span(magic)));
  header.put(endian_tag);
  header.put(format_major);
  header.put(format_minor);
  Bytes bytes = header.take();
  bytes.resize(header_size);
  store(base::xxh3_64(std::span(bytes).first(hashed_of_header)), bytes.data() + hashed_of_header);
  return bytes;
}

std::uint64_t file_size_of(std::span<const Chunk> chunks) {
  std::uint64_t size = header_size + footer_size + entry_size * chunks.size();
  for (const Chunk& chunk : chunks) size += chunk.stored_size;
  return size;
}

std::vector<std::byte> table_and_footer_bytes(std::span<Chunk> chunks) {
  std::uint64_t offset = header_size;
  ByteWriter table;
  for (Chunk& chunk : chunks) {
    chunk.offset = offset;
    offset += chunk.stored_size;
    put_entry(table, chunk);
  }
  ByteWriter footer;
  footer.put(offset);
  footer.put(static_cast<std::uint32_t>(chunks.size()));
  footer.put(std::uint32_t{0});
  footer.put(file_size_of(chunks));
  Bytes bytes = table.take(), tail = footer.take();
  const std::uint64_t hash = file_hash(header_bytes(), bytes, tail);
  tail.resize(footer_size);
  store(hash, tail.data() + hashed_of_footer);
  std::ranges::copy(std::as_bytes(std::span(end_magic)), tail.end() - end_magic.size());
  bytes.insert(bytes.end(), tail.begin(), tail.end());
  return bytes;
}

ChunkFile::ChunkFile(const Source& source) : source_(source) {
  Bytes buffer;
  const std::uint64_t size = source.size();
  if (size < magic.size() || !equal(source.fetch(0, magic.size(), buffer), magic)) {
    fail("this is no file of Silva: it does not begin with the bytes 89 53 49 4C 56 41 0D 0A");
  }
  if (size < header_size + footer_size) {
    fail("it has " + std::to_string(size) + " bytes, the least possible are " +
         std::to_string(header_size + footer_size));
  }
  const auto fetched = source.fetch(0, header_size, buffer);
  const Bytes header(fetched.begin(), fetched.end());
  const auto tag = load<std::uint32_t>(header.data() + 8);
  if (tag != endian_tag) fail("header at byte 8: the endian tag is not 04 03 02 01");
  const auto major = load<std::uint16_t>(header.data() + 12);
  minor_ = load<std::uint16_t>(header.data() + 14);
  if (load<std::uint64_t>(header.data() + hashed_of_header) !=
      base::xxh3_64(std::span(header).first(hashed_of_header))) {
    fail("header at byte 0: its checksum differs; the file is damaged");
  }
  if (major != format_major) {
    fail("it is of format version " + version(major, minor_) + "; this program reads version " +
         version(format_major, format_minor) + (major > format_major ? ", a newer program is needed" : ""));
  }
  read_table(header);
}

void ChunkFile::read_table(std::span<const std::byte> header) {
  Bytes footer_buffer, table_buffer;
  const std::uint64_t size = source_.size(), footer_at = size - footer_size;
  const auto footer = source_.fetch(footer_at, footer_size, footer_buffer);
  const std::string footer_name = "footer at byte " + std::to_string(footer_at);
  if (!equal(footer.last(end_magic.size()), end_magic)) {
    fail(footer_name + ": the file does not end with SILVAEND; it is cut off or something was added");
  }
  const auto table_at = load<std::uint64_t>(footer.data());
  const auto count = load<std::uint32_t>(footer.data() + 8);
  const auto zero = load<std::uint32_t>(footer.data() + 12);
  const auto stated_size = load<std::uint64_t>(footer.data() + 16);
  if (stated_size != size) {
    fail(footer_name + ": the file should have " + std::to_string(stated_size) + " bytes, it has " +
         std::to_string(size));
  }
  if (zero != 0) fail(footer_name + ": a field that must be zero is not");
  if (table_at < header_size || table_at > footer_at || footer_at - table_at != entry_size * count) {
    fail(footer_name + ": a chunk table of " + std::to_string(count) + " entries cannot lie at byte " +
         std::to_string(table_at));
  }
  const auto table = source_.fetch(table_at, footer_at - table_at, table_buffer);
  if (load<std::uint64_t>(footer.data() + hashed_of_footer) != file_hash(header, table, footer)) {
    fail(footer_name + ": the file's hash differs; the chunk table or the footer is damaged");
  }

  ByteReader entries(table, source_.name() + ": chunk table at byte " + std::to_string(table_at));
  std::uint64_t next = header_size, content = 0;
  chunks_.resize(count);
  for (Chunk& chunk : chunks_) {
    if (!get_entry(entries, chunk)) fail(chunk, "a field of its table entry that must be zero is not");
    if (chunk.offset != next) {
      fail(chunk,
           "the chunk before it ends at byte " + std::to_string(next) + "; chunks may neither overlap nor leave gaps");
    }
    if (chunk.stored_size > table_at - next) {
      fail(chunk, "its " + std::to_string(chunk.stored_size) + " bytes run into the chunk table");
    }
    next += chunk.stored_size;
    if (chunk.content_size > most_content(size) - content) {
      fail(chunk, "it claims to unfold to " + std::to_string(chunk.content_size) + " bytes; all chunks of a file of " +
                      std::to_string(size) + " bytes may unfold to " + std::to_string(most_content(size)));
    }
    content += chunk.content_size;
  }
  if (next != table_at) {
    fail("chunk table at byte " + std::to_string(table_at) + ": the last chunk ends at byte " + std::to_string(next));
  }
}

std::span<const std::byte> ChunkFile::checked_bytes(const Chunk& chunk, std::vector<std::byte>& buffer) const {
  const auto bytes = source_.fetch(chunk.offset, chunk.stored_size, buffer);
  if (base::xxh3_64(bytes) != chunk.checksum) fail(chunk, "its checksum differs; the file is damaged");
  return bytes;
}

void ChunkFile::check(const Chunk& chunk) const {
  Bytes buffer;
  checked_bytes(chunk, buffer);
}

void ChunkFile::unpack(const Chunk& chunk, std::span<std::byte> content) const {
  Bytes buffer;
  const auto stored = checked_bytes(chunk, buffer);
  if (chunk.codec == Codec::zstd) {
    if (const std::string problem = decompress(stored, content); !problem.empty()) fail(chunk, problem);
  } else if (chunk.codec == Codec::raw) {
    if (stored.size() != content.size()) {
      fail(chunk, "it is stored as it is, but claims " + std::to_string(content.size()) + " bytes for " +
                      std::to_string(stored.size()));
    }
    std::ranges::copy(stored, content.begin());
  } else {
    fail(chunk, "it is packed in a way (" + std::to_string(static_cast<int>(chunk.codec)) + ") that is unknown");
  }
}

std::vector<std::byte> ChunkFile::content(const Chunk& chunk) const {
  Bytes content(chunk.content_size);
  unpack(chunk, content);
  return content;
}

void ChunkFile::fail(const Chunk& chunk, const std::string& what) const { fail(name_of(chunk) + ": " + what); }

void ChunkFile::fail(const std::string& what) const { throw base::Error(source_.name() + ": " + what); }

}  // namespace silvasim::ecosystem
