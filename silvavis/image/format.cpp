#include "silvavis/image/format.h"

#include <cctype>
#include <string>

#include "silvasim/base/error.h"

namespace silvavis::image {

Format format_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension == ".exr") return Format::exr;
  if (extension == ".png") return Format::png;
  if (extension == ".jpg" || extension == ".jpeg") return Format::jpeg;
  if (extension == ".tif" || extension == ".tiff") return Format::tiff;
  throw silvasim::base::Error("\"" + path.string() + "\": a picture's name ends in .exr, .png, .jpg or .tif");
}

}  // namespace silvavis::image
