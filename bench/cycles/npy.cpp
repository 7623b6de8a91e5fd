#include "cycles/npy.h"

#include <fmt/format.h>

#include <bit>
#include <string>

#include "silvasim/base/file.h"

namespace silva_bench {

namespace {

static_assert(std::endian::native == std::endian::little);

template <typename T>
void write_column(const std::filesystem::path& path, std::span<const T> values, std::size_t width, const char* type) {
  const std::string shape =
      width == 0 ? fmt::format("({},)", values.size()) : fmt::format("({}, {})", values.size() / width, width);
  std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}", type, shape);
  // The data begin at a multiple of 64 bytes, after magic, version, length and a line's end.
  constexpr std::size_t before = 10;
  header.append(63 - (before + header.size()) % 64, ' ');
  header += '\n';
  std::string start("\x93NUMPY\x01\x00", 8);
  start += static_cast<char>(header.size() & 255);
  start += static_cast<char>(header.size() >> 8);
  silvasim::base::NewFile file(path);
  file.write(start + header);
  file.write(std::as_bytes(values));
  file.commit();
}

}  // namespace

void write_npy(const std::filesystem::path& path, std::span<const float> values, std::size_t width) {
  write_column(path, values, width, "<f4");
}

void write_npy(const std::filesystem::path& path, std::span<const std::uint16_t> values, std::size_t width) {
  write_column(path, values, width, "<u2");
}

}  // namespace silva_bench
