// What the module of OpenImageIO offers: the functions of picture_file.h, under one C name.
#pragma once

#include "silvavis/pictures/picture_file.h"

namespace silvavis::pictures {

struct Module {
  std::unique_ptr<PictureFile> (*open_bytes)(Format, const std::string&, std::span<const std::byte>);
  std::unique_ptr<PictureFile> (*open_cached)(Format, const std::filesystem::path&);
};

inline constexpr const char* module_file = "silvavis_openimageio.so";
inline constexpr const char* module_symbol = "silvavis_pictures";

}  // namespace silvavis::pictures
