// Numbers and texts as the ecosystem file stores them: little-endian, IEEE 754, texts as a length and UTF-8.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "silvasim/base/error.h"

namespace silvasim::ecosystem {

using Bytes = std::vector<std::byte>;

template <typename Number>
void store(Number value, std::byte* to) {
  static_assert(std::is_arithmetic_v<Number>);
  std::memcpy(to, &value, sizeof value);
  if constexpr (std::endian::native == std::endian::big) std::reverse(to, to + sizeof value);
}

template <typename Number>
Number load(const std::byte* from) {
  static_assert(std::is_arithmetic_v<Number>);
  std::array<std::byte, sizeof(Number)> bytes;
  std::memcpy(bytes.data(), from, bytes.size());
  if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<Number>(bytes);
}

class ByteWriter {
 public:
  template <typename Number>
  void put(Number value) {
    // Equal ecosystems give equal bytes: minus zero is written as zero.
    if constexpr (std::is_floating_point_v<Number>) value += Number{0};
    bytes_.resize(bytes_.size() + sizeof value);
    store(value, bytes_.data() + bytes_.size() - sizeof value);
  }
  void put_text(const std::string& text) {
    put(static_cast<std::uint32_t>(text.size()));
    put_raw(std::as_bytes(std::span(text)));
  }
  void put_raw(std::span<const std::byte> bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }

  Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
};

// Trusts no length. Errors: base::Error that begins with `where` and names the byte.
class ByteReader {
 public:
  ByteReader(std::span<const std::byte> bytes, std::string where) : bytes_(bytes), where_(std::move(where)) {}

  template <typename Number>
  Number get() {
    need(sizeof(Number), "a number");
    at_ += sizeof(Number);
    return load<Number>(bytes_.data() + at_ - sizeof(Number));
  }
  std::string get_text() {
    const std::uint32_t size = get<std::uint32_t>();
    need(size, "a text");
    const char* text = reinterpret_cast<const char*>(bytes_.data() + at_);
    at_ += size;
    return {text, size};
  }
  // A number of records of at least `least_bytes` each, which must still be there.
  std::uint32_t get_count(std::size_t least_bytes) {
    const std::uint32_t count = get<std::uint32_t>();
    if (left() / least_bytes < count) {
      fail("it announces " + std::to_string(count) + " records, but only " + std::to_string(left()) +
           " bytes are left");
    }
    return count;
  }
  std::size_t left() const { return bytes_.size() - at_; }
  void expect_end() const {
    if (left() != 0) fail(std::to_string(left()) + " bytes follow the last record");
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw base::Error(where_ + ": at byte " + std::to_string(at_) + " of its content: " + what);
  }

 private:
  void need(std::size_t size, const char* what) const {
    if (left() < size) {
      fail(std::string(what) + " of " + std::to_string(size) + " bytes begins, but only " + std::to_string(left()) +
           " are left");
    }
  }

  std::span<const std::byte> bytes_;
  std::string where_;
  std::size_t at_ = 0;
};

}  // namespace silvasim::ecosystem
