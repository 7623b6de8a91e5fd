// The formats that pictures come in, by their names' endings.
#pragma once

#include <filesystem>

#include "assets/pictures/picture_file.h"

namespace silvavis::image {

using assets::pictures::Format;

// .exr, .png, .jpg, .jpeg, .tif, .tiff, in any case. Errors: base::Error that names the file and lists these.
Format format_of(const std::filesystem::path& path);

}  // namespace silvavis::image
