#include "silvasim/fields/raster_field.h"

#include <fmt/format.h>
#include <gdal_priv.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "silvasim/base/error.h"
#include "silvasim/fields/frame.h"
#include "silvasim/fields/gdal_log.h"
#include "silvasim/fields/open.h"
#include "silvasim/fields/read_cells.h"
#include "silvasim/fields/warp.h"

namespace silvasim::fields {

namespace {

// Cells around the window, so that bilinear reading and 3 x 3 derivatives are whole up to its rim.
constexpr int spare_cells = 3;

int merging(double cells) { return std::max(1, int(std::ceil(std::sqrt(cells / most_field_cells)))); }

// The cells between two pixel coordinates (any order), grown and cut to the file.
void cover(double a, double b, int spare, int size, int& first, int& count) {
  const double low = std::floor(std::min(a, b)) - spare, high = std::ceil(std::max(a, b)) + spare;
  first = int(std::clamp(low, 0.0, double(size)));
  count = int(std::clamp(high, 0.0, double(size))) - first;
}

void require_overlap(const config::FieldSettings& field, const Frame& frame, const Crs& scene_crs,
                     const base::Box& box) {
  if (!intersection(box, frame.extent).empty()) return;
  fail_at(field, "\"" + field.path.string() + "\" does not overlap the scene: it reaches from " +
                     (box.empty() ? "nowhere in the scene's CRS" : extent_text(scene_crs, box)) + "; the scene from " +
                     extent_text(scene_crs, frame.extent));
}

RasterField stretched(GDALDataset& dataset, const config::FieldSettings& field, const Frame& frame) {
  const CellWindow all{0, 0, dataset.GetRasterXSize(), dataset.GetRasterYSize()};
  const int block = merging(all.cells());
  const bool grey = field.kind == config::FieldKind::value && !field.terrain && !field.scaled;
  Cells cells = read_cells(dataset, field, grey ? Decoding::grey : Decoding::as_stored, all, block);
  RasterField result;
  Raster& raster = result.raster;
  raster.columns = cells.columns;
  raster.rows = cells.rows;
  raster.west = frame.extent.west;
  raster.north = frame.extent.north;
  raster.cell_width = frame.extent.width() * block / all.columns;
  raster.cell_height = frame.extent.height() * block / all.rows;
  raster.values = std::move(cells.values);
  result.source = "stretched over the scene";
  return result;
}

// The grid lies as the scene does: cut out what is needed, without touching a value.
RasterField cut(GDALDataset& dataset, const config::FieldSettings& field, const Georeference& grid,
                const base::Box& window) {
  const auto& t = grid.transform;
  CellWindow cells;
  cover((window.west - t[0]) / t[1], (window.east - t[0]) / t[1], spare_cells, grid.columns, cells.column,
        cells.columns);
  cover((window.north - t[3]) / t[5], (window.south - t[3]) / t[5], spare_cells, grid.rows, cells.row, cells.rows);
  const int block = merging(cells.cells());
  Cells read = read_cells(dataset, field, Decoding::as_stored, cells, block);

  RasterField result;
  Raster& raster = result.raster;
  raster.columns = read.columns;
  raster.rows = read.rows;
  raster.cell_width = std::abs(t[1]) * block;
  raster.cell_height = std::abs(t[5]) * block;
  const bool mirrored = t[1]<0, south_up = t[5]> 0;
  raster.west = t[0] + t[1] * cells.column;
  raster.north = t[3] + t[5] * cells.row;
  if (mirrored) raster.west -= read.columns * raster.cell_width;
  if (south_up) raster.north += read.rows * raster.cell_height;
  const auto width = static_cast<std::ptrdiff_t>(read.columns);
  if (mirrored) {
    for (auto line = read.values.begin(); line != read.values.end(); line += width) std::reverse(line, line + width);
  }
  if (south_up) {
    for (std::ptrdiff_t a = 0, b = read.rows - 1; a < b; ++a, --b) {
      std::swap_ranges(read.values.begin() + a * width, read.values.begin() + (a + 1) * width,
                       read.values.begin() + b * width);
    }
  }
  raster.values = std::move(read.values);
  result.source = fmt::format("cut to {} x {} cells", raster.columns, raster.rows);
  if (block > 1) result.source += fmt::format(", merged {0} x {0}", block);
  if (!read.note.empty()) result.source += ", " + read.note;
  return result;
}

// Rounded to four digits, so that the last bits of a projection do not become part of the grid.
double tidy_size(double size) {
  const double unit = std::pow(10.0, std::floor(std::log10(size)) - 3);
  return std::round(size / unit) * unit;
}

RasterField warped(GDALDataset& dataset, const config::FieldSettings& field, const Georeference& grid,
                   const Frame& frame, const Crs& scene_crs, const base::Box& window) {
  const PixelMap map(grid, scene_crs);

  // Ask where the window's points lie in the file, and how large a file's cell is in the scene there.
  const PixelBounds pixels = map.bounds(window);
  CellWindow cells;
  if (pixels.any) {
    cover(pixels.least_column, pixels.most_column, spare_cells, grid.columns, cells.column, cells.columns);
    cover(pixels.least_row, pixels.most_row, spare_cells, grid.rows, cells.row, cells.rows);
  }
  if (cells.empty()) {
    fail_at(field, "\"" + field.path.string() + "\" does not overlap the scene: it reaches from " +
                       extent_text(grid.crs, own_extent(grid)) + " in its own CRS, " + name_of(grid.crs) +
                       "; the scene from " + extent_text(scene_crs, frame.extent));
  }
  const int block = merging(cells.cells());
  Cells read = read_cells(dataset, field, Decoding::as_stored, cells, block);

  const CellSize size = map.cell_size(window);
  RasterField result;
  Raster& raster = result.raster;
  raster.cell_width = tidy_size(size.width * block);
  raster.cell_height = tidy_size(size.height * block);
  // A whole number of cells from the scene's corner, and past the window by the spare ones.
  const auto reach = [](double from, double to, double cell) {
    return std::ceil(std::max(0.0, to - from) / cell) + spare_cells;
  };
  const double left = reach(window.west, frame.extent.west, raster.cell_width);
  const double top = reach(frame.extent.north, window.north, raster.cell_height);
  raster.west = frame.extent.west - left * raster.cell_width;
  raster.north = frame.extent.north + top * raster.cell_height;
  const double columns = left + reach(frame.extent.west, window.east, raster.cell_width);
  const double rows = top + reach(window.south, frame.extent.north, raster.cell_height);
  if (columns * rows > 4 * most_field_cells) {
    fail_at(field, fmt::format("its cells of {:.3g} x {:.3g} m are too small for a scene of this size", size.width,
                               size.height));
  }
  raster.columns = int(columns);
  raster.rows = int(rows);
  Georeference part = grid;
  const base::Point corner = grid.at(cells.column, cells.row);
  part.transform = {corner.x, grid.transform[1] * block, grid.transform[2] * block,
                    corner.y, grid.transform[4] * block, grid.transform[5] * block};
  part.columns = read.columns;
  part.rows = read.rows;
  warp(read.values, part, field.kind, scene_crs, raster);
  result.source = fmt::format("warped to {} x {} cells of {:.4g} x {:.4g} m", raster.columns, raster.rows,
                              raster.cell_width, raster.cell_height);
  if (block > 1) result.source += fmt::format(", merged {0} x {0}", block);
  if (!read.note.empty()) result.source += ", " + read.note;
  return result;
}

}  // namespace

RasterField load_raster_field(const config::FieldSettings& field, const Frame& frame, double margin_m) {
  const Dataset dataset = open_raster(field);
  Georeference grid = georeference_of(*dataset, field);
  const Crs scene_crs = crs_of(frame);
  const base::Box window = grown(frame.extent, margin_m);
  if (field.kind == config::FieldKind::class_code && field.scaled) {
    fail_at(field, "class codes take no scale or offset");
  }

  RasterField result;
  if (!grid.placed) {
    result = stretched(*dataset, field, frame);
  } else {
    grid.crs = crs_in_scene(field, grid.crs, grid.crs_known, scene_crs);
    if (grid.axis_parallel() && lies_alike(grid, scene_crs)) {
      require_overlap(field, frame, scene_crs, own_extent(grid));
      result = cut(*dataset, field, grid, window);
    } else {
      result = warped(*dataset, field, grid, frame, scene_crs, window);
    }
  }
  bool any = false;
  for (const float value : result.raster.values) any = any || !std::isnan(value);
  if (!any) fail_at(field, "\"" + field.path.string() + "\" has no data anywhere in the scene");

  const GDALRasterBand& band = *dataset->GetRasterBand(field.band);
  result.source =
      fmt::format("{} {}x{} {}{}, {}, {}", dataset->GetDriver()->GetDescription(), dataset->GetRasterXSize(),
                  dataset->GetRasterYSize(), GDALGetDataTypeName(const_cast<GDALRasterBand&>(band).GetRasterDataType()),
                  dataset->GetRasterCount() > 1 ? fmt::format(" band {}", field.band) : "",
                  grid.placed ? name_of(grid.crs) : "no georeference", result.source);
  return result;
}

}  // namespace silvasim::fields
