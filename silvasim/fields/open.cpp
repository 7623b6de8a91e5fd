#include "silvasim/fields/open.h"

#include <fmt/format.h>
#include <gdal_priv.h>

#include <cmath>
#include <system_error>

#include "silvasim/base/error.h"
#include "silvasim/fields/ascii_grid.h"
#include "silvasim/fields/containment.h"
#include "silvasim/fields/drivers.h"
#include "silvasim/fields/gdal_log.h"

namespace silvasim::fields {

namespace {

// A raster of this many cells is believed whatever its file's size; beyond, a cell may not cost less than a 2000th
// byte. (Deflate packs at best about 1000 to 1; a 10^12-cell "sparse" file of some kilobytes is an attack or a
// mistake.)
constexpr double believed_cells = 1e8;
constexpr double most_cells_a_byte = 2000;
constexpr double most_block_bytes = 1 << 29;
constexpr int most_bands = 10000;

void check_claims(GDALDataset& dataset, const config::FieldSettings& field) {
  const double columns = dataset.GetRasterXSize(), rows = dataset.GetRasterYSize();
  std::error_code ignored;
  const auto file_bytes = static_cast<double>(std::filesystem::file_size(field.path, ignored));
  if (columns * rows > believed_cells && (ignored || columns * rows > most_cells_a_byte * file_bytes)) {
    fail_at(field, fmt::format("\"{}\" claims {:.0f} x {:.0f} cells, but has {:.0f} bytes only", field.path.string(),
                               columns, rows, file_bytes));
  }
  if (dataset.GetRasterCount() > most_bands) {
    fail_at(field, fmt::format("\"{}\" claims {} bands; at most {} are read", field.path.string(),
                               dataset.GetRasterCount(), most_bands));
  }
}

void check_band(GDALDataset& dataset, const config::FieldSettings& field) {
  const int bands = dataset.GetRasterCount();
  if (bands == 0) fail_at(field, "\"" + field.path.string() + "\" holds no raster band");
  if (field.band < 1 || field.band > bands) {
    fail_at(field, fmt::format("there is no band {} in \"{}\"; it has {}", field.band, field.path.string(),
                               bands == 1 ? "one" : "bands 1 to " + std::to_string(bands)));
  }
  GDALRasterBand& band = *dataset.GetRasterBand(field.band);
  const GDALDataType type = band.GetRasterDataType();
  if (GDALDataTypeIsComplex(type)) {
    fail_at(field, fmt::format("\"{}\" holds complex numbers; a field has real ones", field.path.string()));
  }
  int block_columns = 0, block_rows = 0;
  band.GetBlockSize(&block_columns, &block_rows);
  const double block_bytes = double(block_columns) * block_rows * GDALGetDataTypeSizeBytes(type);
  if (block_bytes > most_block_bytes) {
    fail_at(field, fmt::format("\"{}\" is stored in blocks of {:.0f} MB, at most 512 are read; rewrite it in tiles "
                               "(gdal_translate -co TILED=YES)",
                               field.path.string(), block_bytes / (1 << 20)));
  }
}

}  // namespace

void fail_at(const config::FieldSettings& field, const std::string& message) {
  throw base::ConfigError(field.place, "data field \"" + field.name + "\": " + message);
}

std::string name_for_gdal(const config::FieldSettings& field) {
  try {
    return contained_name(field.path);
  } catch (const base::Error& error) {
    fail_at(field, error.what());
  }
}

Crs crs_of_user(const config::FieldSettings& field) {
  try {
    return crs_from_text(field.crs);
  } catch (const base::Error& error) {
    fail_at(field, error.what());
  }
}

void CloseDataset::operator()(GDALDataset* dataset) const { GDALClose(dataset); }

Dataset open_raster(const config::FieldSettings& field) {
  prepare_gdal();
  const std::string name = name_for_gdal(field);
  GdalLog log;
  Dataset dataset(GDALDataset::Open(name.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_INTERNAL,
                                    raster_driver_names(), nullptr, nullptr));
  if (!dataset) {
    fail_at(field,
            "\"" + field.path.string() + "\" cannot be opened as a raster" +
                (log.failed() && log.reason().find("not recognized") == std::string::npos ? ": " + log.reason() : "") +
                "; " + readable_rasters());
  }
  check_claims(*dataset, field);
  check_band(*dataset, field);
  if (const GDALDriver* driver = dataset->GetDriver(); driver && std::string(driver->GetDescription()) == "AAIGrid") {
    if (const std::string wrong = wrong_word_in_ascii_grid(field.path); !wrong.empty()) {
      fail_at(field, "\"" + field.path.string() + "\" holds \"" + wrong + "\" where a number should be");
    }
  }
  return dataset;
}

Georeference georeference_of(GDALDataset& dataset, const config::FieldSettings& field) {
  GdalLog log;
  Georeference result;
  result.columns = dataset.GetRasterXSize();
  result.rows = dataset.GetRasterYSize();
  auto& t = result.transform;
  result.placed = dataset.GetGeoTransform(t.data()) == CE_None;
  const Crs file_crs = crs_from_gdal(dataset.GetSpatialRef());

  if (!result.placed) {
    t = {0, 1, 0, 0, 0, 1};
    if (dataset.GetGCPCount() > 0) {
      fail_at(field, "\"" + field.path.string() + "\" is placed by control points only; rectify it first (gdalwarp)");
    }
    if (file_crs) {
      fail_at(field, "\"" + field.path.string() + "\" names a CRS but not where it lies in it (no geotransform)");
    }
    return result;
  }
  for (const double number : t) {
    if (!std::isfinite(number))
      fail_at(field, "the geotransform of \"" + field.path.string() + "\" holds NaN or infinity");
  }
  const double cell_area = std::abs(t[1] * t[5] - t[2] * t[4]);
  if (!(cell_area > 0) || !std::isfinite(cell_area)) {
    fail_at(field, "the cells of \"" + field.path.string() + "\" have no area (cell size 0)");
  }

  if (field.crs == "local") {
    result.crs_known = true;  // the user says: in the scene's own coordinates
  } else if (!field.crs.empty()) {
    result.crs = crs_of_user(field);
    result.crs_known = true;
  } else {
    result.crs = file_crs;
    result.crs_known = file_crs != nullptr;
  }
  if (is_geographic(result.crs)) {
    const base::Box box = own_extent(result);
    constexpr double slack = 1;  // degrees: some global grids reach half a cell over the pole
    if (box.south < -90 - slack || box.north > 90 + slack || box.west < -540 || box.east > 540) {
      fail_at(field,
              fmt::format("\"{}\" says that its coordinates are degrees ({}), but they reach from {}; crs=\"...\" may "
                          "say the right one",
                          field.path.string(), name_of(result.crs), extent_text(nullptr, box)));
    }
  }
  return result;
}

base::Box own_extent(const Georeference& georeference) {
  base::Box box;
  for (const double column : {0.0, double(georeference.columns)}) {
    for (const double row : {0.0, double(georeference.rows)}) {
      const base::Point corner = georeference.at(column, row);
      box.west = std::min(box.west, corner.x);
      box.east = std::max(box.east, corner.x);
      box.south = std::min(box.south, corner.y);
      box.north = std::max(box.north, corner.y);
    }
  }
  return box;
}

}  // namespace silvasim::fields
