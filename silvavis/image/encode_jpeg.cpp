// clang-format off
#include <cstdio>  // jpeglib.h needs it
#include <jpeglib.h>
// clang-format on

#include <algorithm>
#include <csetjmp>
#include <cstdlib>

#include "silvasim/base/error.h"
#include "silvavis/image/encode.h"

namespace silvavis::image {

namespace {

struct Writer {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  std::jmp_buf out_of_here{};
  unsigned char* bytes = nullptr;
  unsigned long count = 0;

  Writer() {
    jpeg.err = jpeg_std_error(&errors);
    errors.error_exit = leave;
    errors.output_message = [](j_common_ptr) {};
    jpeg.client_data = this;
    attempt([this] {
      jpeg_create_compress(&jpeg);
      jpeg_mem_dest(&jpeg, &bytes, &count);
    });
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() {
    jpeg_destroy_compress(&jpeg);
    std::free(bytes);
  }

  // libjpeg jumps out of `act` at an error: nothing in there may need destroying.
  template <class Act>
  void attempt(const Act& act) {
    if (setjmp(out_of_here)) {
      char reason[JMSG_LENGTH_MAX];
      errors.format_message(reinterpret_cast<j_common_ptr>(&jpeg), reason);
      throw silvasim::base::Error(reason);
    }
    act();
  }

  static void leave(j_common_ptr jpeg) { std::longjmp(static_cast<Writer*>(jpeg->client_data)->out_of_here, 1); }
};

}  // namespace

Bytes jpeg_of(const Shown& shown, int quality, const Strips<std::uint8_t>& strips) {
  Writer writer;
  writer.attempt([&] {
    writer.jpeg.image_width = static_cast<JDIMENSION>(shown.width);
    writer.jpeg.image_height = static_cast<JDIMENSION>(shown.height);
    writer.jpeg.input_components = 3;
    writer.jpeg.in_color_space = JCS_RGB;
    jpeg_set_defaults(&writer.jpeg);
    jpeg_set_quality(&writer.jpeg, quality, TRUE);
    jpeg_start_compress(&writer.jpeg, TRUE);
    if (!shown.description.empty()) {
      constexpr std::size_t most = 65533;
      jpeg_write_marker(&writer.jpeg, JPEG_COM, reinterpret_cast<const JOCTET*>(shown.description.data()),
                        static_cast<unsigned int>(std::min(shown.description.size(), most)));
    }
  });
  const std::size_t row_bytes = static_cast<std::size_t>(shown.width) * 3;
  for (int first = 0; first < shown.height; first += strip_rows) {
    const int end = std::min(first + strip_rows, shown.height);
    std::vector<std::uint8_t> strip = strips(first, end);
    writer.attempt([&] {
      for (int row = 0; row < end - first; ++row) {
        JSAMPROW from = strip.data() + static_cast<std::size_t>(row) * row_bytes;
        jpeg_write_scanlines(&writer.jpeg, &from, 1);
      }
    });
  }
  writer.attempt([&] { jpeg_finish_compress(&writer.jpeg); });
  return Bytes(writer.bytes, writer.bytes + writer.count);
}

}  // namespace silvavis::image
