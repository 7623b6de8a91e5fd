#include <png.h>

#include <algorithm>

#include "silvasim/base/error.h"
#include "silvavis/image/encode.h"

namespace silvavis::image {

namespace {

struct Writer {
  png_structp png = nullptr;
  png_infop info = nullptr;
  Bytes bytes;
  std::string reason;

  Writer() : png(png_create_write_struct(PNG_LIBPNG_VER_STRING, this, note_error, nullptr)) {
    info = png ? png_create_info_struct(png) : nullptr;
    if (!info) throw silvasim::base::Error("libpng does not start");
    png_set_write_fn(png, this, append, nullptr);
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { png_destroy_write_struct(&png, &info); }

  // libpng jumps out of `act` at an error: nothing in there may need destroying.
  template <class Act>
  void attempt(const Act& act) {
    if (setjmp(png_jmpbuf(png))) throw silvasim::base::Error(reason);
    act();
  }

  static void note_error(png_structp png, png_const_charp message) {
    static_cast<Writer*>(png_get_error_ptr(png))->reason = message;
    png_longjmp(png, 1);
  }
  static void append(png_structp png, png_bytep data, png_size_t count) {
    Bytes& to = static_cast<Writer*>(png_get_io_ptr(png))->bytes;
    to.insert(to.end(), data, data + count);
  }
};

}  // namespace

Bytes png_of(const Shown& shown, const Strips<std::uint8_t>& strips) {
  Writer writer;
  std::string key = "Description", text = shown.description;
  png_text description{};
  description.compression = PNG_TEXT_COMPRESSION_NONE;
  description.key = key.data();
  description.text = text.data();
  description.text_length = text.size();
  writer.attempt([&] {
    png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(shown.width), static_cast<png_uint_32>(shown.height),
                 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(writer.png, writer.info, PNG_sRGB_INTENT_ABSOLUTE);
    if (!shown.description.empty()) png_set_text(writer.png, writer.info, &description, 1);
    png_write_info(writer.png, writer.info);
  });
  const std::size_t row_bytes = static_cast<std::size_t>(shown.width) * 3;
  writer.bytes.reserve(row_bytes * static_cast<std::size_t>(shown.height));  // pages that stay empty cost nothing
  for (int first = 0; first < shown.height; first += strip_rows) {
    const int end = std::min(first + strip_rows, shown.height);
    const std::vector<std::uint8_t> strip = strips(first, end);
    writer.attempt([&] {
      for (int row = 0; row < end - first; ++row)
        png_write_row(writer.png, strip.data() + static_cast<std::size_t>(row) * row_bytes);
    });
  }
  writer.attempt([&] { png_write_end(writer.png, nullptr); });
  return std::move(writer.bytes);
}

}  // namespace silvavis::image
