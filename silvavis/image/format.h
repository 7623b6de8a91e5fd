// The formats that pictures come in, by their names' endings.
#pragma once

#include <filesystem>

namespace silvavis::image {

enum class Format { exr, png, jpeg, tiff };

// .exr, .png, .jpg, .jpeg, .tif, .tiff, in any case. Errors: base::Error that names the file and lists these.
Format format_of(const std::filesystem::path& path);

// What OpenImageIO calls it.
const char* plugin_of(Format format);

}  // namespace silvavis::image
