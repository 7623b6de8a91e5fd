// Files of pictures as OpenImageIO reads them.
//
// OpenImageIO and what it brings along (OpenCV, FFmpeg, OpenVDB) take 90 MB by being loaded. So it stands in a module beside the
// programs, silva_openimageio.so, which is loaded when the first picture is read; whoever only writes pictures never
// loads it.
// Errors: base::Error with the reason alone (the caller names the picture), also where the module cannot be loaded.
// Threads: open_*() from several at once; one PictureFile by one thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace assets::pictures {

enum class Format : std::uint8_t { exr, png, jpeg, tiff, bmp, targa };

enum class Sample : std::uint8_t { u8, u16, u32, half, f32, other };

// What a file claims. Look at it before a pixel is read.
struct Shape {
  struct Channel {
    std::string name;
    Sample sample = Sample::other;
  };
  int width = 0, height = 0, depth = 1;
  std::vector<Channel> channels;
  bool alpha = false;           // one of the channels is an alpha
  bool deep = false;            // several samples a pixel
  std::size_t pixel_bytes = 0;  // as stored
};

class PictureFile {
 public:
  virtual ~PictureFile() = default;

  const Shape& shape() const { return shape_; }

  // Rows [first_row, end_row) of channels [first_channel, end_channel) as `sample`, row by row. Alphas are straight.
  virtual void read(int first_row, int end_row, int first_channel, int end_channel, Sample sample, void* to) = 0;

 protected:
  Shape shape_;
};

// A picture in memory, which must outlive it; `name` is for messages of the libraries.
std::unique_ptr<PictureFile> open_bytes(Format format, const std::string& name, std::span<const std::byte> bytes);

// A file, through one cache of OpenImageIO for all, which knows when a file has changed.
std::unique_ptr<PictureFile> open_cached(Format format, const std::filesystem::path& file);

}  // namespace assets::pictures
