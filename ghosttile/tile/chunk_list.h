// A file of Silva's container (silvasim/ecosystem/chunks.h) as a plain list of chunks, for the small files of ghosttile.
//
// Promise: every byte is covered by a checksum; the same chunks give the same bytes; output appears only when it is whole.
// Errors: base::Error naming the file, the chunk and the byte; a file that unfolds to more than the container allows is refused.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "silvasim/ecosystem/bytes.h"
#include "silvasim/ecosystem/chunks.h"

namespace ghosttile::tile {

using silvasim::ecosystem::ByteReader;
using silvasim::ecosystem::Bytes;
using silvasim::ecosystem::ByteWriter;
using silvasim::ecosystem::ChunkType;

struct NamedChunk {
  ChunkType type{};
  Bytes content;
};

Bytes file_bytes(std::vector<NamedChunk> chunks);
void write_bytes(const Bytes& bytes, const std::filesystem::path& path, std::span<const std::filesystem::path> inputs);

// `kind`: what the file should be, for the message where its first chunk is another than `first`.
std::vector<NamedChunk> chunks_from(std::span<const std::byte> bytes, const std::string& name, const ChunkType& first,
                                    const std::string& kind);
std::vector<NamedChunk> read_chunks(const std::filesystem::path& path, const ChunkType& first, const std::string& kind);

// A reader of the only chunk of that type. Errors: base::Error where there is none, or several.
ByteReader reader_of(const std::vector<NamedChunk>& chunks, const ChunkType& type, const std::string& name);

template <typename Number>
void put_column(ByteWriter& to, const std::vector<Number>& column) {
  to.put(static_cast<std::uint32_t>(column.size()));
  for (const Number value : column) to.put(value);
}
template <typename Number>
std::vector<Number> get_column(ByteReader& from) {
  std::vector<Number> column(from.get_count(sizeof(Number)));
  for (Number& value : column) value = from.get<Number>();
  return column;
}

}  // namespace ghosttile::tile
