#include "silvasim/fields/picture.h"

#include <gdal_priv.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "silvasim/fields/open.h"
#include "silvasim/fields/raster_field.h"

namespace silvasim::fields {

namespace {

// Which bands are red, green and blue; one band alone is grey or has a palette.
std::vector<int> colour_bands(GDALDataset& dataset) {
  if (dataset.GetRasterCount() < 3) return {1};
  std::vector<int> bands{1, 2, 3};
  const std::array<GDALColorInterp, 3> roles = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand};
  for (int i = 1; i <= dataset.GetRasterCount(); ++i) {
    const GDALColorInterp role = dataset.GetRasterBand(i)->GetColorInterpretation();
    for (std::size_t k = 0; k < roles.size(); ++k) {
      if (role == roles[k]) bands[k] = i;
    }
  }
  return bands;
}

// The number that stands for full light.
float full_light(GDALRasterBand& band, const config::FieldSettings& field) {
  const char* const bits_text = band.GetMetadataItem("NBITS", "IMAGE_STRUCTURE");
  const int bits = bits_text ? std::atoi(bits_text) : 0;
  if (bits > 0 && bits <= 16) return static_cast<float>((1 << bits) - 1);
  if (band.GetRasterDataType() == GDT_Byte) return 255;
  if (band.GetRasterDataType() == GDT_UInt16) return 65535;
  fail_at(field, "\"" + field.path.string() + "\" holds " + GDALGetDataTypeName(band.GetRasterDataType()) +
                     " numbers, and a picture 8 or 16 bits; gdal_translate -ot Byte -scale makes one of it");
}

}  // namespace

std::vector<PaletteEntry> load_palette(const config::FieldSettings& field) {
  const Dataset dataset = open_raster(field);
  const GDALColorTable* const table = dataset->GetRasterBand(field.band)->GetColorTable();
  std::vector<PaletteEntry> palette;
  for (int i = 0; table && i < table->GetColorEntryCount(); ++i) {
    GDALColorEntry c{};
    table->GetColorEntryAsRGB(i, &c);
    const auto byte = [](short value) { return static_cast<std::uint8_t>(std::clamp<short>(value, 0, 255)); };
    if (c.c4 != 0) palette.push_back({i, {byte(c.c1), byte(c.c2), byte(c.c3)}});
  }
  return palette;
}

Picture load_picture(const config::FieldSettings& settings, const Frame& frame, double margin_m) {
  config::FieldSettings field = settings;
  std::vector<int> bands;
  std::vector<float> full;
  {
    const Dataset dataset = open_raster(field);
    bands = colour_bands(*dataset);
    for (const int band : bands) full.push_back(full_light(*dataset->GetRasterBand(band), field));
  }
  const std::vector<PaletteEntry> palette = bands.size() == 1 ? load_palette(field) : std::vector<PaletteEntry>{};
  std::vector<const PaletteEntry*> entries;  // by code
  for (const PaletteEntry& entry : palette) {
    entries.resize(static_cast<std::size_t>(entry.code) + 1);
    entries.back() = &entry;
  }
  // Raw numbers, also of an image without georeference.
  field.kind = palette.empty() ? config::FieldKind::value : config::FieldKind::class_code;
  field.scaled = palette.empty();

  Picture picture;
  for (std::size_t k = 0; k < bands.size(); ++k) {
    field.band = bands[k];
    const Raster raster = load_raster_field(field, frame, margin_m).raster;
    if (k == 0) {
      picture.columns = raster.columns;
      picture.rows = raster.rows;
      picture.west = raster.west;
      picture.north = raster.north;
      picture.cell_width = raster.cell_width;
      picture.cell_height = raster.cell_height;
      picture.rgba.assign(raster.values.size() * 4, 255);
    }
    for (std::size_t i = 0; i < raster.values.size(); ++i) {
      std::uint8_t* const pixel = picture.rgba.data() + i * 4;
      const float value = raster.values[i];
      if (!palette.empty()) {
        const bool known = value >= 0 && value < static_cast<float>(entries.size());  // not NaN
        const PaletteEntry* const entry = known ? entries[static_cast<std::size_t>(value)] : nullptr;
        if (entry) std::copy(entry->rgb.begin(), entry->rgb.end(), pixel);
        if (!entry) pixel[3] = 0;
      } else if (std::isnan(value)) {
        pixel[3] = 0;
      } else {
        const auto byte = static_cast<std::uint8_t>(std::clamp(value / full[k], 0.0f, 1.0f) * 255 + 0.5f);
        if (bands.size() == 1) std::fill_n(pixel, 3, byte);
        pixel[k] = byte;
      }
    }
  }
  return picture;
}

}  // namespace silvasim::fields
