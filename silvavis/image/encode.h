// Pictures as the bytes of a file, each format by its own library: these are small or in the process anyway, where
// OpenImageIO would take 90 MB to write one picture.
//
// Promise: the same input gives the same bytes. In memory, so that every error of the disk is NewFile's to find.
// Errors: base::Error with the reason alone. Threads: any.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "silvavis/image/image.h"

namespace silvavis::image {

using Bytes = std::vector<std::uint8_t>;

inline constexpr int strip_rows = 16;  // that the encoders ask for at once

// Rows [first, end) of three channels in sRGB's encoding.
template <typename Value>
using Strips = std::function<std::vector<Value>(int first, int end)>;

struct Shown {
  int width = 0, height = 0;
  std::string description;  // empty: none
};

Bytes png_of(const Shown& shown, const Strips<std::uint8_t>& strips);
Bytes jpeg_of(const Shown& shown, int quality, const Strips<std::uint8_t>& strips);
Bytes tiff_of(const Shown& shown, const Strips<std::uint16_t>& strips);  // deflated

// All that the frame holds; colours and normals in 32 bit where `whole_floats`, else in 16. Each pair of `attributes` becomes an
// attribute of type string.
Bytes exr_of(const Frame& frame, bool whole_floats, const std::map<std::string, std::string>& attributes);

}  // namespace silvavis::image
