// What the module of OpenImageIO offers: the functions of picture_file.h, under one C name.
#pragma once

#include "assets/pictures/picture_file.h"

namespace assets::pictures {

struct Module {
  std::unique_ptr<PictureFile> (*open_bytes)(Format, const std::string&, std::span<const std::byte>);
  std::unique_ptr<PictureFile> (*open_cached)(Format, const std::filesystem::path&);
};

inline constexpr const char* module_file = "silva_openimageio.so";
inline constexpr const char* module_symbol = "assets_pictures";

}  // namespace assets::pictures
