// Files that tests write, and pictures read back by other means than they were written.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace silvasim::testing {

// A folder that goes when the test ends.
class Folder {
 public:
  Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder();

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  std::vector<std::string> names() const;  // of the files in it, sorted

 private:
  std::filesystem::path path_;
};

std::string content(const std::filesystem::path& path);

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint32_t> colours;  // 0xRRGGBB

  std::uint32_t at(int x, int y) const {
    return colours[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

Picture read_png(const std::filesystem::path& path);  // width 0 where it is none

// The affine map of a world file.
struct World {
  double east = 0, south = 0, x = 0, y = 0;  // step of a pixel; centre of the first

  double pixel_x(double scene_x) const { return (scene_x - x) / east; }
  double pixel_y(double scene_y) const { return (scene_y - y) / south; }
};

World read_world(const std::filesystem::path& path);

}  // namespace silvasim::testing
