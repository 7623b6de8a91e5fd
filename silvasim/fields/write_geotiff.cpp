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
void write(const std::filesystem::path& path, const Band& band, std::span<const Number> values, GDALDataType type) {
  const auto cells = static_cast<std::size_t>(band.columns) * static_cast<std::size_t>(band.rows);
  if (band.columns <= 0 || band.rows <= 0 || values.size() != cells)
    throw std::logic_error("a band's values do not fit its size");
  const bool real = type == GDT_Float32;
  const char* const options[] = {"TILED=YES", "COMPRESS=DEFLATE", real ? "PREDICTOR=3" : "PREDICTOR=2",
                                 "BIGTIFF=IF_SAFER", nullptr};
  GdalLog log;
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  {
    GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    Dataset dataset(driver ? driver->Create(path.c_str(), band.columns, band.rows, 1, type, const_cast<char**>(options))
                           : nullptr);
    if (!dataset) fail(path, log);
    std::array<double, 6> transform = {band.west, band.cell_width, 0, band.north, 0, -band.cell_height};
    dataset->SetGeoTransform(transform.data());
    if (const Crs crs = band.crs_wkt.empty() ? nullptr : crs_from_text(band.crs_wkt)) dataset->SetSpatialRef(crs.get());
    GDALRasterBand& out = *dataset->GetRasterBand(1);
    if (band.no_data) out.SetNoDataValue(*band.no_data);
    if (!band.description.empty()) out.SetDescription(band.description.c_str());
    if (out.RasterIO(GF_Write, 0, 0, band.columns, band.rows, const_cast<Number*>(values.data()), band.columns,
                     band.rows, type, 0, 0, nullptr) != CE_None) {
      fail(path, log);
    }
    // The last blocks and the directory are written while closing, and only the log hears what goes wrong then.
    dataset->FlushCache(true);
  }
  if (log.failed()) fail(path, log);

  const Dataset again(
      GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_INTERNAL, raster_driver_names()));
  std::vector<Number> line(static_cast<std::size_t>(band.columns));
  bool whole = again && again->GetRasterXSize() == band.columns && again->GetRasterYSize() == band.rows;
  for (int row = 0; whole && row < band.rows; ++row) {
    whole = again->GetRasterBand(1)->RasterIO(GF_Read, 0, row, band.columns, 1, line.data(), band.columns, 1, type, 0,
                                              0, nullptr) == CE_None &&
            std::memcmp(line.data(), values.data() + static_cast<std::size_t>(row) * line.size(),
                        line.size() * sizeof(Number)) == 0;
  }
  if (!whole || log.failed()) fail(path, log);
}

}  // namespace

void write_geotiff(const std::filesystem::path& path, const Band& band) {
  prepare_gdal();
  if (const auto* const real = std::get_if<std::span<const float>>(&band.values))
    write(path, band, *real, GDT_Float32);
  else
    write(path, band, std::get<std::span<const std::uint8_t>>(band.values), GDT_Byte);
}

}  // namespace silvasim::fields
