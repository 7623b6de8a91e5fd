// A picture's rows as 8-bit RGBA; files through OpenImageIO's cache.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "assets/pictures/picture_file.h"
#include "assets/texture.h"

namespace assets {

class PictureRows {
 public:
  // Looks at the size only. Errors: base::Error for what is no known format, or too large.
  explicit PictureRows(const Picture& picture);

  int width() const { return width_; }
  int height() const { return height_; }
  bool has_alpha() const { return has_alpha_; }

  // Rows [first, end), 4 bytes a pixel, row by row; alpha is 255 where the picture has none.
  void read(int first, int end, std::vector<std::uint8_t>& rgba);

 private:
  std::string name_;                             // for messages
  std::unique_ptr<pictures::PictureFile> file_;  // none: one white pixel
  int width_ = 1;
  int height_ = 1;
  bool has_alpha_ = false;
};

}  // namespace assets
