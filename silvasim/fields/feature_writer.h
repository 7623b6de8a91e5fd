// Points and rasters out, as files that GIS programs open. Which columns there are and how they look is the caller's.
//
// Every function writes whole to `path` and returns when the file is closed; a full disk is an error. Give it
// base::NewFile's path() and commit() afterwards. The same values give the same bytes.
//
// Errors: base::Error naming the path; base::Cancelled when `progress` says stop; a half-written file may remain.
//   std::logic_error for columns, blocks or sizes that do not fit each other.
// Threads: any, one file a call.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "silvasim/base/progress.h"

namespace silvasim::fields {

enum class PointFormat {
  geopackage,  // one point layer in the frame's CRS, with a spatial index, and its style where one is given
  flatgeobuf,  // the same without style, several times as fast; the name must end in .fgb
};

enum class ColumnType { integer, number, text };

struct PointColumn {
  std::string name;
  ColumnType type = ColumnType::integer;
  std::vector<std::string> words = {};  // text: what the indices of the blocks stand for
};

struct PointLayer {
  std::string name = "plants";
  std::string crs_wkt;               // empty: none
  std::vector<PointColumn> columns;  // names differ, also in lower case, and from "fid", "geom", "x" and "y"
  std::string style_qml;             // geopackage: the layer's default style in QGIS; empty: none
  bool spatial_index = true;         // geopackage: three quarters of the time
};

// Some points, column by column, every span of the same length. The values of a text column are indices into its words,
// -1 = null; a number that is not finite is null.
struct PointBlock {
  std::span<const double> x, y;
  std::vector<std::variant<std::span<const std::int64_t>, std::span<const double>>> columns;
};

// Asks `next_block` for blocks until it gives none; a block's spans are read before the next is asked for. Blocks of some
// thousands of points serve well. `count`, if known, is for the progress (stage "write", then "index") only. The points
// keep their order, but in a FlatGeobuf, whose index sorts them.
void write_points(const std::filesystem::path& path, PointFormat format, const PointLayer& layer,
                  const std::function<std::optional<PointBlock>()>& next_block, std::size_t count = 0,
                  const base::Progress& progress = {});

// What all bands of a raster share.
struct Grid {
  int columns = 0;
  int rows = 0;
  double west = 0, north = 0;              // the grid's corner
  double cell_width = 1, cell_height = 1;  // metres, > 0
  std::optional<double> no_data;           // NaN is allowed for float
  std::string crs_wkt;                     // empty: none
};

// Row by row, row 0 northernmost.
struct Band {
  std::variant<std::span<const float>, std::span<const std::uint8_t>> values;
  std::string description;  // the band's name, e.g. "probability"
};

// A tiled, compressed GeoTIFF, read back once to see that it is whole. One band at least, all of one type.
void write_geotiff(const std::filesystem::path& path, const Grid& grid, std::span<const Band> bands);

}  // namespace silvasim::fields
