// What must hold when any bytes are read as an ecosystem file; shared by the fuzzer and the replay of its seeds.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <span>
#include <vector>

#include "silvasim/base/error.h"
#include "silvasim/ecosystem/file.h"
#include "unit/ecosystem/surgery.h"

namespace silvasim::ecosystem {

// Refused with an error, or read; and what was read can be written and read again. True when it was read.
inline bool read_or_refuse(std::span<const std::byte> bytes) {
  std::optional<Ecosystem> ecosystem;
  try {
    ecosystem = from_bytes(bytes, "fuzz");
  } catch (const base::Error&) {
    return false;
  }
  if (!(from_bytes(to_bytes(*ecosystem), "again") == *ecosystem)) {
    std::fputs("what was read does not come back\n", stderr);
    std::abort();
  }
  return true;
}

// The same bytes with all checksums right, so that what lies behind them is reached.
inline std::optional<FileBytes> with_checksums_mended(std::span<const std::byte> bytes) {
  if (bytes.size() < 64) return std::nullopt;
  FileBytes file(bytes.begin(), bytes.end());
  const auto mend = [&file](std::size_t at, std::uint64_t checksum) { std::memcpy(file.data() + at, &checksum, 8); };
  mend(16, xxh3(std::span(file).first(16)));
  const std::size_t footer = file.size() - 40;
  const auto table = number_at<std::uint64_t>(file, footer);
  if (table < 24 || table > footer) return file;
  for (std::size_t at = table; at + 56 <= footer; at += 56) {
    const auto offset = number_at<std::uint64_t>(file, at + 24), stored = number_at<std::uint64_t>(file, at + 32);
    if (offset <= file.size() && stored <= file.size() - offset) {
      mend(at + 48, xxh3(std::span(file).subspan(offset, stored)));
    }
  }
  FileBytes hashed(file.begin(), file.begin() + 24);
  hashed.insert(hashed.end(), file.begin() + static_cast<std::ptrdiff_t>(table), file.end() - 16);
  mend(file.size() - 16, xxh3(hashed));
  return file;
}

inline bool try_file(std::span<const std::byte> bytes) {
  const bool read = read_or_refuse(bytes);
  const auto mended = with_checksums_mended(bytes);
  return (mended && read_or_refuse(*mended)) || read;
}

}  // namespace silvasim::ecosystem
