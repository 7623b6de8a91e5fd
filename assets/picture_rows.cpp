#include "assets/picture_rows.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

#include "silvasim/base/error.h"
#include "silvasim/base/words.h"

namespace assets {

namespace {

namespace base = silvasim::base;
using pictures::Format;

// Names the format by the first bytes, so that no other reader gets to see the file. Targa has no magic bytes.
std::optional<Format> format_of(const std::string& head, const std::string& name) {
  const auto begins = [&](std::string_view magic) { return head.compare(0, magic.size(), magic) == 0; };
  using namespace std::string_view_literals;
  if (begins("\x89PNG\r\n\x1A\n"sv)) return Format::png;
  if (begins("\xFF\xD8\xFF"sv)) return Format::jpeg;
  if (begins("BM"sv)) return Format::bmp;
  if (begins("II*\0"sv) || begins("MM\0*"sv)) return Format::tiff;
  std::string end = name.size() > 4 ? name.substr(name.size() - 4) : "";
  std::transform(end.begin(), end.end(), end.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (end == ".tga") return Format::targa;
  return {};
}

std::string first_bytes(const Picture& picture) {
  std::string head(8, '\0');
  if (picture.file.empty()) {
    const std::size_t count = std::min(head.size(), picture.bytes.size());
    std::transform(picture.bytes.begin(), picture.bytes.begin() + static_cast<std::ptrdiff_t>(count), head.begin(),
                   [](std::byte b) { return static_cast<char>(b); });
  } else {
    std::ifstream(picture.file, std::ios::binary).read(head.data(), static_cast<std::streamsize>(head.size()));
  }
  return head;
}

[[noreturn]] void fail(const std::string& name, const std::string& what) {
  throw base::Error("texture \"" + base::shortened(name, 120) + "\" " + what);
}

std::string first_line(const base::Error& error) {
  const std::string why = error.what();
  return base::shortened(why.substr(0, why.find('\n')), 120);
}

}  // namespace

PictureRows::PictureRows(const Picture& picture) : name_(picture.name) {
  if (picture.file.empty() && picture.bytes.empty()) return;
  const std::optional<Format> format = format_of(first_bytes(picture), picture.name);
  if (!format) fail(name_, "is no picture; it should be PNG, JPEG, Targa, BMP or TIFF");
  try {
    file_ = picture.file.empty() ? pictures::open_bytes(*format, picture.name, picture.bytes)
                                 : pictures::open_cached(*format, picture.file);
  } catch (const base::Error& error) {
    fail(name_, "cannot be read: " + first_line(error));
  }
  const pictures::Shape& shape = file_->shape();
  const long long pixels = static_cast<long long>(shape.width) * shape.height;
  const bool fits = shape.width > 0 && shape.height > 0 && shape.depth <= 1 && !shape.channels.empty() &&
                    shape.width <= most_picture_side_px && shape.height <= most_picture_side_px &&
                    pixels <= most_picture_px;
  // No packing makes more of a byte; a file that claims more is cut off, or made to waste time.
  constexpr long long most_pixels_a_byte = 8192;
  std::error_code ignored;
  const auto bytes = static_cast<long long>(picture.file.empty() ? picture.bytes.size()
                                                                 : std::filesystem::file_size(picture.file, ignored));
  if (!fits || pixels > most_pixels_a_byte * bytes) {
    fail(name_, "claims " + std::to_string(shape.width) + " x " + std::to_string(shape.height) + " pixels, which " +
                    (fits ? "its " + std::to_string(bytes) + " bytes cannot hold"
                          : "is too large; at most " + std::to_string(most_picture_side_px) + " a side and " +
                                std::to_string(most_picture_px >> 20) + " million in all are read"));
  }
  width_ = shape.width;
  height_ = shape.height;
  has_alpha_ = shape.channels.size() == 2 || (shape.channels.size() >= 4 && shape.alpha);
}

void PictureRows::read(int first, int end, std::vector<std::uint8_t>& rgba) {
  const auto pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(end - first);
  rgba.assign(pixels * 4, 255);
  if (!file_) return;
  const std::size_t channels = std::min<std::size_t>(file_->shape().channels.size(), 4);
  std::vector<std::uint8_t> raw(pixels * channels);
  try {
    file_->read(first, end, 0, static_cast<int>(channels), pictures::Sample::u8, raw.data());
  } catch (const base::Error& error) {
    fail(name_, "is damaged: " + first_line(error));
  }
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint8_t* in = raw.data() + i * channels;
    std::uint8_t* out = rgba.data() + i * 4;
    const bool grey = channels < 3;
    for (int c = 0; c < 3; ++c) out[c] = in[grey ? 0 : c];
    if (has_alpha_) out[3] = in[grey ? 1 : 3];
  }
}

}  // namespace assets
