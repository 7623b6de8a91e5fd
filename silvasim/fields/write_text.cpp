#include "silvasim/fields/write_text.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>

#include "silvasim/base/error.h"
#include "silvasim/fields/crs.h"

namespace silvasim::fields {

namespace {

// A file that is written through a buffer of a megabyte.
class TextFile {
 public:
  explicit TextFile(const std::filesystem::path& path)
      : path_(path), file_(std::fopen(path.c_str(), "wb"), std::fclose) {
    if (!file_) fail();
    buffer_.reserve(flush_at + 4096);
  }

  std::string& buffer() {
    if (buffer_.size() > flush_at) flush();
    return buffer_;
  }

  void close() {
    flush();
    const bool good = std::fflush(file_.get()) == 0;
    if (std::fclose(file_.release()) != 0 || !good) fail();
  }

 private:
  static constexpr std::size_t flush_at = 1 << 20;

  void flush() {
    if (std::fwrite(buffer_.data(), 1, buffer_.size(), file_.get()) != buffer_.size()) fail();
    buffer_.clear();
  }

  [[noreturn]] void fail() const {
    throw base::Error("cannot write \"" + path_.string() + "\": " + std::strerror(errno));
  }

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::string buffer_;
};

void append(std::string& text, std::int32_t value) {
  std::array<char, 16> digits{};
  text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

// `digits` after the point; negative: as many as are needed to read the number back.
void append(std::string& text, double value, int digits) {
  std::array<char, 512> room{};  // the largest double has 309 digits before the point
  char* const end = room.data() + room.size();
  const auto result = digits < 0
                          ? std::to_chars(room.data(), end, value)
                          : std::to_chars(room.data(), end, value == 0 ? 0.0 : value, std::chars_format::fixed, digits);
  text.append(room.data(), result.ptr);
}

// A value of a column; `null` where there is none.
void append(std::string& text, const PointColumn& column, const std::vector<std::string>& words,
            const PointBlock& block, std::size_t k, std::size_t i, const char* null) {
  if (column.type == ColumnType::number) {
    const double value = std::get<std::span<const double>>(block.columns[k])[i];
    if (std::isfinite(value))
      append(text, value, column.digits);
    else
      text += null;
    return;
  }
  const std::int32_t value = std::get<std::span<const std::int32_t>>(block.columns[k])[i];
  if (column.type == ColumnType::integer)
    append(text, value);
  else if (value >= 0)
    text += words[static_cast<std::size_t>(value)];
  else
    text += null;
}

std::string csv_quoted(const std::string& word) {
  if (word.find_first_of(",\"\r\n") == std::string::npos) return word;
  std::string text = "\"";
  for (const char c : word) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  return text + "\"";
}

std::string json_quoted(const std::string& word) {
  std::string text = "\"";
  for (const char c : word) {
    if (c == '"' || c == '\\') {
      text += '\\';
      text += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      constexpr const char* hex = "0123456789abcdef";
      text += "\\u00";
      text += hex[(c >> 4) & 15];
      text += hex[c & 15];
    } else {
      text += c;
    }
  }
  return text + "\"";
}

// Every word as it stands in the file, made once and not a row at a time.
template <typename Quote>
std::vector<std::vector<std::string>> quoted_words(const PointLayer& layer, const Quote& quote) {
  std::vector<std::vector<std::string>> result;
  for (const PointColumn& column : layer.columns) {
    result.emplace_back();
    for (const std::string& word : column.words) result.back().push_back(quote(word));
  }
  return result;
}

}  // namespace

void write_csv(const std::filesystem::path& path, const PointLayer& layer,
               const std::function<std::optional<PointBlock>()>& next_block) {
  TextFile file(path);
  file.buffer() += "x,y";
  for (const PointColumn& column : layer.columns) file.buffer() += "," + csv_quoted(column.name);
  file.buffer() += "\n";
  const auto words = quoted_words(layer, csv_quoted);
  while (const auto block = next_block()) {
    for (std::size_t i = 0; i < block->x.size(); ++i) {
      std::string& text = file.buffer();
      append(text, block->x[i], layer.coordinate_digits);
      text += ',';
      append(text, block->y[i], layer.coordinate_digits);
      for (std::size_t k = 0; k < layer.columns.size(); ++k) {
        text += ',';
        append(text, layer.columns[k], words[k], *block, k, i, "");
      }
      text += '\n';
    }
  }
  file.close();
}

void write_geojson(const std::filesystem::path& path, const PointLayer& layer,
                   const std::function<std::optional<PointBlock>()>& next_block) {
  const Crs crs = layer.crs_wkt.empty() ? nullptr : crs_from_text(layer.crs_wkt);
  const Transformation to_degrees(crs, crs ? wgs84() : nullptr);
  const int digits = layer.coordinate_digits + (crs ? 5 : 0);
  TextFile file(path);
  file.buffer() += "{\"type\":\"FeatureCollection\",\"name\":" + json_quoted(layer.name) + ",\"features\":[";
  const auto words = quoted_words(layer, json_quoted);
  std::vector<std::string> labels;
  for (const PointColumn& column : layer.columns) labels.push_back(json_quoted(column.name) + ":");
  const char* separator = "\n";
  while (const auto block = next_block()) {
    std::vector<double> x(block->x.begin(), block->x.end()), y(block->y.begin(), block->y.end());
    to_degrees.apply(x, y);
    for (std::size_t i = 0; i < x.size(); ++i) {
      std::string& text = file.buffer();
      text += separator;
      separator = ",\n";
      text += "{\"type\":\"Feature\",\"properties\":{";
      for (std::size_t k = 0; k < layer.columns.size(); ++k) {
        if (k) text += ',';
        text += labels[k];
        append(text, layer.columns[k], words[k], *block, k, i, "null");
      }
      if (std::isfinite(x[i]) && std::isfinite(y[i])) {
        text += "},\"geometry\":{\"type\":\"Point\",\"coordinates\":[";
        append(text, x[i], digits);
        text += ',';
        append(text, y[i], digits);
        text += "]}}";
      } else {
        text += "},\"geometry\":null}";
      }
    }
  }
  file.buffer() += "\n]}\n";
  file.close();
}

}  // namespace silvasim::fields
