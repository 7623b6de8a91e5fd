#include <gdal_priv.h>

#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "silvasim/base/error.h"
#include "silvasim/fields/crs.h"
#include "silvasim/fields/drivers.h"
#include "silvasim/fields/feature_writer.h"
#include "silvasim/fields/gdal_log.h"
#include "silvasim/fields/open.h"

namespace silvasim::fields {

namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const GdalLog& log) {
  throw base::Error("cannot write \"" + path.string() + "\": " + log.reason());
}

template <typename Number>
void write(const std::filesystem::path& path, const Grid& grid, std::span<const Band> bands, GDALDataType type) {
  const auto cells = static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows);
  const auto values_of = [&](const Band& band) -> const Number* {
    const auto* const values = std::get_if<std::span<const Number>>(&band.values);
    if (grid.columns <= 0 || grid.rows <= 0 || !values || values->size() != cells)
      throw std::logic_error("a band's values do not fit its size or the other bands' type");
    return values->data();
  };
  for (const Band& band : bands) values_of(band);
  const bool real = type == GDT_Float32;
  // Three bands of bytes are no picture, and a fourth is no transparency.
  const char* const options[] = {"TILED=YES",
                                 "COMPRESS=DEFLATE",
                                 real ? "PREDICTOR=3" : "PREDICTOR=2",
                                 "BIGTIFF=IF_SAFER",
                                 "INTERLEAVE=BAND",
                                 "PHOTOMETRIC=MINISBLACK",
                                 "ALPHA=NO",
                                 nullptr};
  const auto count = static_cast<int>(bands.size());
  GdalLog log;
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  {
    GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    Dataset dataset(
        driver ? driver->Create(path.c_str(), grid.columns, grid.rows, count, type, const_cast<char**>(options))
               : nullptr);
    if (!dataset) fail(path, log);
    std::array<double, 6> transform = {grid.west, grid.cell_width, 0, grid.north, 0, -grid.cell_height};
    dataset->SetGeoTransform(transform.data());
    if (const Crs crs = grid.crs_wkt.empty() ? nullptr : crs_from_text(grid.crs_wkt)) dataset->SetSpatialRef(crs.get());
    // What the file's head tells comes before the values: rewritten, it would leave a hole.
    for (int b = 0; b < count; ++b) {
      GDALRasterBand& out = *dataset->GetRasterBand(b + 1);
      const std::string& description = bands[static_cast<std::size_t>(b)].description;
      if (grid.no_data) out.SetNoDataValue(*grid.no_data);
      if (!description.empty()) out.SetDescription(description.c_str());
    }
    for (int b = 0; b < count; ++b) {
      auto* const values = const_cast<Number*>(values_of(bands[static_cast<std::size_t>(b)]));
      if (dataset->GetRasterBand(b + 1)->RasterIO(GF_Write, 0, 0, grid.columns, grid.rows, values, grid.columns,
                                                  grid.rows, type, 0, 0, nullptr) != CE_None) {
        fail(path, log);
      }
    }
    // The last blocks and the directory are written while closing, and only the log hears what goes wrong then.
    dataset->FlushCache(true);
  }
  if (log.failed()) fail(path, log);

  const Dataset again(
      GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_INTERNAL, raster_driver_names()));
  std::vector<Number> line(static_cast<std::size_t>(grid.columns));
  bool whole = again && again->GetRasterXSize() == grid.columns && again->GetRasterYSize() == grid.rows &&
               again->GetRasterCount() == count;
  for (int b = 0; whole && b < count; ++b) {
    const Number* values = values_of(bands[static_cast<std::size_t>(b)]);
    for (int row = 0; whole && row < grid.rows; ++row, values += grid.columns) {
      whole = again->GetRasterBand(b + 1)->RasterIO(GF_Read, 0, row, grid.columns, 1, line.data(), grid.columns, 1,
                                                    type, 0, 0, nullptr) == CE_None &&
              std::memcmp(line.data(), values, line.size() * sizeof(Number)) == 0;
    }
  }
  if (!whole || log.failed()) fail(path, log);
}

}  // namespace

void write_geotiff(const std::filesystem::path& path, const Grid& grid, std::span<const Band> bands) {
  prepare_gdal();
  if (bands.empty()) throw std::logic_error("a raster without bands");
  if (std::holds_alternative<std::span<const float>>(bands.front().values))
    write<float>(path, grid, bands, GDT_Float32);
  else
    write<std::uint8_t>(path, grid, bands, GDT_Byte);
}

}  // namespace silvasim::fields
