// A raster's colours on the scene's frame: photographs and maps of the land, and the palettes of class rasters.
//
// Errors: as load_raster_field()'s, and base::ConfigError for what is no picture.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "silvasim/config/field_settings.h"
#include "silvasim/fields/field_set.h"

namespace silvasim::fields {

struct Picture {
  int columns = 0, rows = 0;
  double west = 0, north = 0;  // of the grid's corner, in the scene's frame
  double cell_width = 1, cell_height = 1;
  std::vector<std::uint8_t>
      rgba;  // row by row, row 0 northernmost; as stored (sRGB by custom); alpha is 255, or 0: no data
};

// One band of grey or of a palette, or three of red, green and blue, 8 or 16 bits each. Grid and cost as of
// load_raster_field(); palettes are not interpolated.
Picture load_picture(const config::FieldSettings& field, const Frame& frame, double margin_m);

struct PaletteEntry {
  int code = 0;
  std::array<std::uint8_t, 3> rgb{};
};

// The colours that the file has for the codes of the field's band, transparent ones left out; empty: none.
std::vector<PaletteEntry> load_palette(const config::FieldSettings& field);

}  // namespace silvasim::fields
