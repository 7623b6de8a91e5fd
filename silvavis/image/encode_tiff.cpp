#include <tiffio.h>

#include <algorithm>
#include <cstring>
#include <memory>

#include "silvasim/base/error.h"
#include "silvavis/image/encode.h"

namespace silvavis::image {

namespace {

// A file in memory, as libtiff wants it.
struct Memory {
  Bytes bytes;
  std::size_t at = 0;

  static Memory& of(thandle_t handle) { return *static_cast<Memory*>(handle); }

  static tmsize_t read(thandle_t handle, void* to, tmsize_t count) {
    Memory& m = of(handle);
    const std::size_t left = m.bytes.size() - std::min(m.at, m.bytes.size());
    const std::size_t taken = std::min(left, static_cast<std::size_t>(count));
    std::memcpy(to, m.bytes.data() + m.at, taken);
    m.at += taken;
    return static_cast<tmsize_t>(taken);
  }
  static tmsize_t write(thandle_t handle, void* from, tmsize_t count) {
    Memory& m = of(handle);
    const std::size_t end = m.at + static_cast<std::size_t>(count);
    if (end > m.bytes.size()) m.bytes.resize(end);
    std::memcpy(m.bytes.data() + m.at, from, static_cast<std::size_t>(count));
    m.at = end;
    return count;
  }
  static toff_t seek(thandle_t handle, toff_t offset, int whence) {
    Memory& m = of(handle);
    m.at = static_cast<std::size_t>(offset) + (whence == SEEK_CUR ? m.at : whence == SEEK_END ? m.bytes.size() : 0);
    return m.at;
  }
  static int close(thandle_t) { return 0; }
  static toff_t size(thandle_t handle) { return of(handle).bytes.size(); }
};

}  // namespace

Bytes tiff_of(const Shown& shown, const Strips<std::uint16_t>& strips) {
  const auto good = [](bool done) {
    if (!done) throw silvasim::base::Error("libtiff does not take it");
  };
  Memory memory;
  // Pages that stay empty cost nothing.
  memory.bytes.reserve(static_cast<std::size_t>(shown.width) * static_cast<std::size_t>(shown.height) * 6);
  {
    const std::unique_ptr<TIFF, void (*)(TIFF*)> tiff(
        TIFFClientOpen("picture", "wm", &memory, Memory::read, Memory::write, Memory::seek, Memory::close, Memory::size,
                       nullptr, nullptr),
        TIFFClose);
    good(tiff != nullptr);
    TIFF* const t = tiff.get();
    good(TIFFSetField(t, TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(shown.width)) &&
         TIFFSetField(t, TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(shown.height)) &&
         TIFFSetField(t, TIFFTAG_SAMPLESPERPIXEL, 3) && TIFFSetField(t, TIFFTAG_BITSPERSAMPLE, 16) &&
         TIFFSetField(t, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB) &&
         TIFFSetField(t, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) &&
         TIFFSetField(t, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT) &&
         TIFFSetField(t, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE) &&
         TIFFSetField(t, TIFFTAG_PREDICTOR, PREDICTOR_HORIZONTAL) &&
         TIFFSetField(t, TIFFTAG_ROWSPERSTRIP, static_cast<std::uint32_t>(strip_rows)));
    if (!shown.description.empty()) good(TIFFSetField(t, TIFFTAG_IMAGEDESCRIPTION, shown.description.c_str()));
    for (int first = 0; first < shown.height; first += strip_rows) {
      std::vector<std::uint16_t> strip = strips(first, std::min(first + strip_rows, shown.height));
      const auto bytes = static_cast<tmsize_t>(strip.size() * sizeof(std::uint16_t));
      good(TIFFWriteEncodedStrip(t, static_cast<std::uint32_t>(first / strip_rows), strip.data(), bytes) == bytes);
    }
    good(TIFFFlush(t) == 1);
  }
  return std::move(memory.bytes);
}

}  // namespace silvavis::image
