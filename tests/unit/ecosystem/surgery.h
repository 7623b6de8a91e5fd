// Takes ecosystem files apart and puts them together again, damaged where a test wants them so, with all checksums
// right. Written from docs/ecosystem-file.md and not from the room's sources, so it checks that document as well.
#pragma once

#include <xxhash.h>
#include <zstd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace silvasim::ecosystem {

using FileBytes = std::vector<std::byte>;

template <typename Number>
Number number_at(std::span<const std::byte> bytes, std::size_t at) {
  Number number;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

template <typename Number>
void append(FileBytes& bytes, Number number) {
  const auto* raw = reinterpret_cast<const std::byte*>(&number);
  bytes.insert(bytes.end(), raw, raw + sizeof number);
}

struct Part {
  std::string type;  // four characters
  std::uint16_t flags = 0;
  std::uint8_t codec = 1;
  std::uint32_t layer = 0xFFFFFFFF, first_row = 0, rows = 0;
  FileBytes content{};

  // Lies, told instead of the truth.
  std::optional<FileBytes> stored{};
  std::optional<std::uint64_t> offset{}, stored_size{}, content_size{}, checksum{};
  std::uint8_t first_zero = 0;
  std::uint32_t second_zero = 0;
};

struct Anatomy {
  std::uint32_t endian_tag = 0x01020304;
  std::uint16_t major = 1, minor = 0;
  std::vector<Part> parts;

  std::optional<std::uint64_t> table_offset, file_size, hash;
  std::optional<std::uint32_t> count;
  std::uint32_t footer_zero = 0;
  FileBytes before_table;  // stray bytes

  Part& part(const std::string& type) {
    for (Part& p : parts) {
      if (p.type == type) return p;
    }
    throw std::runtime_error("the file has no chunk " + type);
  }
};

inline FileBytes squeezed(std::span<const std::byte> content, int level = 3) {
  FileBytes stored(ZSTD_compressBound(content.size()));
  stored.resize(ZSTD_compress(stored.data(), stored.size(), content.data(), content.size(), level));
  return stored;
}

inline std::uint64_t xxh3(std::span<const std::byte> bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

// Header, table and footer must lie where they belong, or it throws; what a chunk's entry says may be untrue.
inline Anatomy take_apart(std::span<const std::byte> file) {
  const auto need = [](bool holds) {
    if (!holds) throw std::runtime_error("no ecosystem file");
  };
  need(file.size() >= 64);
  Anatomy anatomy;
  anatomy.endian_tag = number_at<std::uint32_t>(file, 8);
  anatomy.major = number_at<std::uint16_t>(file, 12);
  anatomy.minor = number_at<std::uint16_t>(file, 14);
  const std::size_t footer = file.size() - 40, table = number_at<std::uint64_t>(file, footer);
  need(table >= 24 && table <= footer && (footer - table) % 56 == 0);
  std::size_t next = 24;
  for (std::size_t at = table; at < footer; at += 56) {
    Part part;
    part.type.assign(reinterpret_cast<const char*>(file.data() + at), 4);
    part.flags = number_at<std::uint16_t>(file, at + 4);
    part.codec = number_at<std::uint8_t>(file, at + 6);
    part.layer = number_at<std::uint32_t>(file, at + 8);
    part.first_row = number_at<std::uint32_t>(file, at + 12);
    part.rows = number_at<std::uint32_t>(file, at + 16);
    const auto offset = number_at<std::uint64_t>(file, at + 24), stored = number_at<std::uint64_t>(file, at + 32);
    const auto content = number_at<std::uint64_t>(file, at + 40);
    need(offset == next && stored <= table - next);
    next += stored;
    const auto bytes = file.subspan(offset, stored);
    part.content.assign(bytes.begin(), bytes.end());
    if (part.codec == 1) {
      constexpr std::uint64_t most = 1 << 26;
      FileBytes unfolded(std::min(content, most));
      if (content <= most &&
          ZSTD_decompress(unfolded.data(), unfolded.size(), bytes.data(), bytes.size()) == unfolded.size()) {
        part.content = unfolded;
      } else {
        part.stored = part.content;
        part.content_size = content;
      }
    }
    anatomy.parts.push_back(part);
  }
  return anatomy;
}

inline FileBytes put_together(const Anatomy& anatomy) {
  static constexpr unsigned char magic[] = {0x89, 'S', 'I', 'L', 'V', 'A', '\r', '\n'};
  FileBytes file;
  for (const unsigned char c : magic) file.push_back(static_cast<std::byte>(c));
  append(file, anatomy.endian_tag);
  append(file, anatomy.major);
  append(file, anatomy.minor);
  append(file, xxh3(file));

  FileBytes table;
  for (const Part& part : anatomy.parts) {
    const FileBytes stored = part.stored ? *part.stored : part.codec == 1 ? squeezed(part.content) : part.content;
    for (std::size_t i = 0; i < 4; ++i) table.push_back(static_cast<std::byte>(part.type.at(i)));
    append(table, part.flags);
    append(table, part.codec);
    append(table, part.first_zero);
    append(table, part.layer);
    append(table, part.first_row);
    append(table, part.rows);
    append(table, part.second_zero);
    append(table, part.offset.value_or(file.size()));
    append(table, part.stored_size.value_or(stored.size()));
    append(table, part.content_size.value_or(part.content.size()));
    append(table, part.checksum.value_or(xxh3(stored)));
    file.insert(file.end(), stored.begin(), stored.end());
  }
  file.insert(file.end(), anatomy.before_table.begin(), anatomy.before_table.end());

  FileBytes footer;
  append(footer, anatomy.table_offset.value_or(file.size()));
  append(footer, anatomy.count.value_or(static_cast<std::uint32_t>(anatomy.parts.size())));
  append(footer, anatomy.footer_zero);
  append(footer, anatomy.file_size.value_or(file.size() + table.size() + 40));
  FileBytes hashed(file.begin(), file.begin() + 24);
  hashed.insert(hashed.end(), table.begin(), table.end());
  hashed.insert(hashed.end(), footer.begin(), footer.end());
  append(footer, anatomy.hash.value_or(xxh3(hashed)));
  file.insert(file.end(), table.begin(), table.end());
  file.insert(file.end(), footer.begin(), footer.end());
  for (const char c : {'S', 'I', 'L', 'V', 'A', 'E', 'N', 'D'}) file.push_back(static_cast<std::byte>(c));
  return file;
}

}  // namespace silvasim::ecosystem
