// One zstd frame a chunk, level 3. The only part of the room that includes zstd.
//
// Promise: same bytes and same version of zstd, same frame.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace silvasim::ecosystem {

std::vector<std::byte> compress(std::span<const std::byte> content);

// Fills `content`, whose size must be what the frame claims; allocates nothing that depends on the frame. Returns what
// is wrong, or an empty string.
std::string decompress(std::span<const std::byte> stored, std::span<std::byte> content);

}  // namespace silvasim::ecosystem
