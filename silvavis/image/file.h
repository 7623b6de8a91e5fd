// Pictures as files: EXR, PNG, JPEG and TIFF.
//
// .exr keeps the light as it is, and beside the colour what each pixel shows: channels R, G, B, Z (metres along the
//   ray), N.X, N.Y, N.Z, and the whole numbers `species` and `plant` (image.h says what they mean). Blender, Nuke and
//   GDAL read them.
// .png and .jpg are what the eye would see: tone-mapped (tone.h), 8 bit sRGB; .tif the same in 16 bit. Their other
//   channels go to one EXR beside, frame.png to frame.aov.exr, which holds the colour too.
//
// Promise: the same frame and options give the same bytes; a file appears only when it is whole.
// Errors: base::Error that names the file: unknown extension, too many pixels, more pixels than a file of that size
//   can hold, broken data, a full disk, an output that is an input.
// Threads: any; concurrent calls for different files are safe.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "silvavis/image/image.h"

namespace silvavis::image {

inline constexpr int most_side_px = 32768;
inline constexpr long long most_pixels = 512ll << 20;

struct WriteOptions {
  std::optional<double> exposure_stops;         // for .png, .jpg, .tif; none: automatic (tone.h). EXR is never changed
  int jpeg_quality = 92;                        // 1 to 100
  bool whole_floats = false;                    // colours and normals of an EXR in 32 bit instead of 16
  std::map<std::string, std::string> metadata;  // EXR: an attribute each; others: lines of the description
  std::vector<std::filesystem::path> inputs;    // must not be overwritten
};

void write(const std::filesystem::path& path, const Frame& frame, const WriteOptions& options = {});

// The files that write() makes beside `path` for such a frame.
std::vector<std::filesystem::path> files_beside(const std::filesystem::path& path, const Frame& frame);

// Checks the name before hours of rendering: errors as write() would.
void check_writable(const std::filesystem::path& path, const WriteOptions& options = {});

// A picture's colours: 3 channels, or 4 where it has an alpha (straight, not multiplied into the colour). Whole numbers
// are taken as sRGB and made linear, floats are taken as they are; grey becomes three equal channels.
Image read(const std::filesystem::path& path);

// Everything that write() puts into an EXR; of other files the colour alone.
Frame read_frame(const std::filesystem::path& path);

}  // namespace silvavis::image
