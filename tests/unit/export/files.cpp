#include "files.h"

#include <cairo.h>
#include <stdlib.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace silvasim::testing {

Folder::Folder() {
  std::string name = (std::filesystem::temp_directory_path() / "silva-export-XXXXXX").string();
  path_ = mkdtemp(name.data());
}

Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::vector<std::string> Folder::names() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(path_))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

Picture read_png(const std::filesystem::path& path) {
  Picture picture;
  cairo_surface_t* surface = cairo_image_surface_create_from_png(path.c_str());
  if (cairo_surface_status(surface) == CAIRO_STATUS_SUCCESS) {
    picture.width = cairo_image_surface_get_width(surface);
    picture.height = cairo_image_surface_get_height(surface);
    const unsigned char* bytes = cairo_image_surface_get_data(surface);
    for (int y = 0; y < picture.height; ++y) {
      const auto* row =
          reinterpret_cast<const std::uint32_t*>(bytes + std::ptrdiff_t{y} * cairo_image_surface_get_stride(surface));
      for (int x = 0; x < picture.width; ++x) picture.colours.push_back(row[x] & 0xFFFFFF);
    }
  }
  cairo_surface_destroy(surface);
  return picture;
}

World read_world(const std::filesystem::path& path) {
  std::ifstream file(path);
  World world;
  double turn = 0;
  file >> world.east >> turn >> turn >> world.south >> world.x >> world.y;
  return world;
}

}  // namespace silvasim::testing
