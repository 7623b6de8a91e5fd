#include "ghosttile/export/png.h"

#include <png.h>

#include <vector>

#include "silvasim/base/error.h"

namespace ghosttile::exports {

std::string png_of(const assets::Texture& texture) {
  std::vector<std::uint8_t> rgb;
  if (!texture.has_alpha) {
    rgb.reserve(texture.rgba.size() / 4 * 3);
    for (std::size_t i = 0; i + 3 < texture.rgba.size(); i += 4)
      rgb.insert(rgb.end(), {texture.rgba[i], texture.rgba[i + 1], texture.rgba[i + 2]});
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(texture.width);
  image.height = static_cast<png_uint_32>(texture.height);
  image.format = texture.has_alpha ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
  const std::uint8_t* pixels = texture.has_alpha ? texture.rgba.data() : rgb.data();
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels, 0, nullptr) == 0) {
    const std::string reason = image.message;
    png_image_free(&image);
    throw silvasim::base::Error("cannot write texture \"" + texture.name + "\" as PNG: " + reason);
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace ghosttile::exports
