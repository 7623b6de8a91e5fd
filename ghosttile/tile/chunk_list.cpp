#include "ghosttile/tile/chunk_list.h"

#include "silvasim/base/error.h"
#include "silvasim/base/file.h"
#include "silvasim/ecosystem/records.h"
#include "silvasim/ecosystem/source.h"

namespace ghosttile::tile {

namespace eco = silvasim::ecosystem;

Bytes file_bytes(std::vector<NamedChunk> named) {
  Bytes bytes = eco::header_bytes();
  std::vector<eco::Chunk> chunks;
  std::uint64_t content = 0;
  const auto add = [&](eco::Chunk chunk, const Bytes& of) {
    const Bytes stored = eco::pack(chunk, of);
    bytes.insert(bytes.end(), stored.begin(), stored.end());
    chunks.push_back(chunk);
    content += of.size();
  };
  for (const NamedChunk& chunk : named) {
    eco::Chunk packed;
    packed.type = chunk.type;
    add(packed, chunk.content);
  }
  // As the ecosystem file does: what is all alike unfolds to more than readers believe of so small a file.
  if (content > eco::most_content(eco::file_size_of(chunks))) {
    eco::Chunk filler{.type = eco::filler_type, .flags = eco::flag_optional, .codec = eco::Codec::raw};
    add(filler, Bytes((content - eco::most_content(eco::file_size_of(chunks))) / 1023 + 1));
  }
  const Bytes end = eco::table_and_footer_bytes(chunks);
  bytes.insert(bytes.end(), end.begin(), end.end());
  return bytes;
}

void write_bytes(const Bytes& bytes, const std::filesystem::path& path, std::span<const std::filesystem::path> inputs) {
  silvasim::base::NewFile file(path, inputs);
  file.write(bytes);
  file.commit();
}

namespace {

std::vector<NamedChunk> chunks_of(const eco::Source& source, const ChunkType& first, const std::string& kind) {
  const eco::ChunkFile file(source);
  if (file.chunks().empty() || file.chunks()[0].type != first)
    throw silvasim::base::Error(source.name() + ": this is no " + kind + ", but another file of Silva");
  std::vector<NamedChunk> chunks;
  for (const eco::Chunk& chunk : file.chunks()) {
    if (chunk.type == eco::filler_type) {
      file.check(chunk);
    } else {
      chunks.push_back({chunk.type, file.content(chunk)});
    }
  }
  return chunks;
}

}  // namespace

std::vector<NamedChunk> chunks_from(std::span<const std::byte> bytes, const std::string& name, const ChunkType& first,
                                    const std::string& kind) {
  return chunks_of(*eco::source_from_memory(bytes, name), first, kind);
}

std::vector<NamedChunk> read_chunks(const std::filesystem::path& path, const ChunkType& first,
                                    const std::string& kind) {
  return chunks_of(*eco::source_from_file(path), first, kind);
}

ByteReader reader_of(const std::vector<NamedChunk>& chunks, const ChunkType& type, const std::string& name) {
  const std::string called = "chunk " + std::string(type.begin(), type.end());
  const NamedChunk* found = nullptr;
  for (const NamedChunk& chunk : chunks) {
    if (chunk.type != type) continue;
    if (found) throw silvasim::base::Error(name + ": " + called + " is there twice");
    found = &chunk;
  }
  if (!found) throw silvasim::base::Error(name + ": " + called + " is missing");
  return ByteReader(found->content, name + ": " + called);
}

}  // namespace ghosttile::tile
