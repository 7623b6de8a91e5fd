// Text and numbers into a new file, in large pieces.
//
// Numbers as text are the shortest that read back the same. Errors: as base::NewFile.
#pragma once

#include <bit>
#include <charconv>
#include <concepts>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "silvasim/base/file.h"

namespace ghosttile::exports {

class Writer {
 public:
  explicit Writer(const std::filesystem::path& path, std::span<const std::filesystem::path> inputs = {})
      : file_(path, inputs) {
    piece_.reserve(piece_bytes + 4096);
  }

  Writer& operator<<(std::string_view text) {
    piece_.append(text);
    if (piece_.size() >= piece_bytes) flush();
    return *this;
  }
  Writer& operator<<(char c) {
    piece_ += c;
    return *this;
  }
  template <typename Number>
  requires(std::integral<Number> || std::floating_point<Number>) Writer& operator<<(Number number) {
    char digits[32];
    return *this << std::string_view(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
  }

  // The number's bytes, the lowest first.
  template <typename Number>
  void put(Number number) {
    static_assert(std::endian::native == std::endian::little);
    char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    *this << std::string_view(bytes, sizeof bytes);
  }

  void commit() {
    flush();
    file_.commit();
  }

 private:
  static constexpr std::size_t piece_bytes = 1 << 20;

  void flush() {
    file_.write(piece_);
    piece_.clear();
  }

  silvasim::base::NewFile file_;
  std::string piece_;
};

}  // namespace ghosttile::exports
