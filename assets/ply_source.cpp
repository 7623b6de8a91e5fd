#include "assets/ply_source.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <sstream>

#include "silvasim/base/words.h"

namespace assets {

namespace {

std::optional<PlyType> type_named(const std::string& name) {
  struct Name {
    const char *old_name, *new_name;
    PlyType type;
  };
  constexpr std::array names{Name{"char", "int8", PlyType::i8},      Name{"uchar", "uint8", PlyType::u8},
                             Name{"short", "int16", PlyType::i16},   Name{"ushort", "uint16", PlyType::u16},
                             Name{"int", "int32", PlyType::i32},     Name{"uint", "uint32", PlyType::u32},
                             Name{"float", "float32", PlyType::f32}, Name{"double", "float64", PlyType::f64}};
  for (const Name& n : names) {
    if (name == n.old_name || name == n.new_name) return n.type;
  }
  return std::nullopt;
}

std::size_t bytes_of(PlyType type) {
  constexpr std::array<std::size_t, 8> bytes{1, 1, 2, 2, 4, 4, 4, 8};
  return bytes[static_cast<std::size_t>(type)];
}

template <typename T>
double as(const std::array<unsigned char, 8>& bytes) {
  T value;
  std::memcpy(&value, bytes.data(), sizeof value);
  return static_cast<double>(value);
}

}  // namespace

double ply_greatest(PlyType type) {
  switch (type) {
    case PlyType::u8:
      return 255;
    case PlyType::u16:
      return 65535;
    case PlyType::u32:
      return 4294967295.0;
    default:
      return 0;
  }
}

void PlySource::fail(const std::string& what) const {
  if (in_header_ || format_ == Format::text) reading_.fail_at(line_, what);
  reading_.fail(what + " at byte " + std::to_string(at_));
}

std::string PlySource::header_line() {
  ++line_;
  if (at_ >= bytes_.size()) fail("the header does not end; it should with \"end_header\"");
  const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
  std::string line = bytes_.substr(at_, std::min<std::size_t>(end - at_, 4096));
  at_ = std::min(end + 1, bytes_.size());
  if (!line.empty() && line.back() == '\r') line.pop_back();
  return line;
}

std::vector<PlyElement> PlySource::read_header() {
  if (header_line() != "ply") fail("it is no PLY file; its first line should be \"ply\"");
  std::vector<PlyElement> elements;
  bool format_known = false;
  while (true) {
    const std::string line = header_line();
    std::istringstream words(line);
    std::string kind, first, second, third, fourth;
    words >> kind;
    if (kind == "end_header") break;
    if (kind.empty() || kind == "obj_info") continue;
    if (kind == "comment") {
      words >> first;
      if (first == "TextureFile") std::getline(words >> std::ws, texture_file_);
      continue;
    }
    words >> first >> second >> third >> fourth;
    if (kind == "format") {
      if (first == "ascii") {
        format_ = Format::text;
      } else if (first == "binary_little_endian") {
        format_ = Format::little;
      } else if (first == "binary_big_endian") {
        format_ = Format::big;
      } else {
        fail("the format \"" + silvasim::base::shortened(first, 40) +
             "\" is not known; it should be ascii, binary_little_endian or binary_big_endian");
      }
      format_known = true;
    } else if (kind == "element") {
      PlyElement element{first, 0, {}};
      const auto [end, error] = std::from_chars(second.data(), second.data() + second.size(), element.count);
      if (first.empty() || second.empty() || error != std::errc{} || end != second.data() + second.size()) {
        fail("an element should have a name and a number");
      }
      if (elements.size() >= 256) fail("it has too many elements");
      elements.push_back(std::move(element));
    } else if (kind == "property") {
      if (elements.empty()) fail("a property stands before any element");
      PlyProperty property;
      property.is_list = first == "list";
      const std::optional<PlyType> type = type_named(property.is_list ? third : first);
      const std::optional<PlyType> count_type = property.is_list ? type_named(second) : PlyType::u8;
      property.name = property.is_list ? fourth : second;
      if (!type || !count_type || property.name.empty()) {
        fail("a property should be like \"property float x\" or \"property list uchar int vertex_indices\"");
      }
      property.type = *type;
      property.count_type = *count_type;
      if (elements.back().properties.size() >= 256) fail("an element has too many properties");
      elements.back().properties.push_back(std::move(property));
    } else {
      fail("\"" + silvasim::base::shortened(kind, 40) + "\" is not known in a header");
    }
  }
  if (!format_known) fail("the header lacks its format");
  in_header_ = false;
  ++line_;

  // Each element needs its bytes: in text, a character and a space a number.
  std::size_t left = bytes_.size() - at_ + 1;
  for (const PlyElement& element : elements) {
    std::size_t bytes = 0;
    for (const PlyProperty& property : element.properties) {
      bytes += format_ == Format::text ? 2 : bytes_of(property.is_list ? property.count_type : property.type);
    }
    if (bytes > 0 && element.count > left / bytes) {
      fail("the header promises " + std::to_string(element.count) + " of element \"" +
           silvasim::base::shortened(element.name, 40) + "\", which the file is too short for");
    }
    left -= bytes * element.count;
  }
  return elements;
}

double PlySource::number(PlyType type) {
  if (format_ == Format::text) return text_number(type);
  const std::size_t size = bytes_of(type);
  if (bytes_.size() - at_ < size) fail("the file ends too early");
  std::array<unsigned char, 8> raw{};
  std::memcpy(raw.data(), bytes_.data() + at_, size);
  const bool native = (format_ == Format::little) == (std::endian::native == std::endian::little);
  if (!native) std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(size));
  at_ += size;
  switch (type) {
    case PlyType::i8:
      return as<std::int8_t>(raw);
    case PlyType::u8:
      return as<std::uint8_t>(raw);
    case PlyType::i16:
      return as<std::int16_t>(raw);
    case PlyType::u16:
      return as<std::uint16_t>(raw);
    case PlyType::i32:
      return as<std::int32_t>(raw);
    case PlyType::u32:
      return as<std::uint32_t>(raw);
    case PlyType::f32:
      return as<float>(raw);
    case PlyType::f64:
      return as<double>(raw);
  }
  return 0;
}

double PlySource::text_number(PlyType type) {
  while (at_ < bytes_.size() &&
         (bytes_[at_] == ' ' || bytes_[at_] == '\t' || bytes_[at_] == '\r' || bytes_[at_] == '\n')) {
    if (bytes_[at_] == '\n') ++line_;
    ++at_;
  }
  if (at_ >= bytes_.size()) fail("the file ends too early");
  if (bytes_[at_] == '+') ++at_;
  double value = 0;
  const char* start = bytes_.data() + at_;
  const char* stop = bytes_.data() + bytes_.size();
  const auto [end, error] = std::from_chars(start, stop, value);
  const bool ends = end == stop || *end == ' ' || *end == '\t' || *end == '\r' || *end == '\n';
  const bool whole = type == PlyType::f32 || type == PlyType::f64 || value == std::floor(value);
  if (error != std::errc{} || !ends || !whole || !std::isfinite(value)) {
    const std::size_t length = std::min(bytes_.find_first_of(" \t\r\n", at_), bytes_.size()) - at_;
    fail("\"" + silvasim::base::shortened(bytes_.substr(at_, std::min<std::size_t>(length, 100)), 40) +
         "\" is no such number");
  }
  at_ += static_cast<std::size_t>(end - start);
  return value;
}

}  // namespace assets
