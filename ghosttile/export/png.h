// A texture as the bytes of a PNG file: its colours as they are, alpha where it has any.
//
// Promise: same texture, same bytes; read back it is the same. Errors: base::Error naming the texture.
#pragma once

#include <string>

#include "assets/model.h"

namespace ghosttile::exports {

std::string png_of(const assets::Texture& texture);

}  // namespace ghosttile::exports
