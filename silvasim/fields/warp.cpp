#include "silvasim/fields/warp.h"

#include <gdal_alg.h>
#include <gdal_priv.h>
#include <gdalwarper.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "silvasim/base/error.h"
#include "silvasim/base/progress.h"
#include "silvasim/fields/gdal_log.h"
#include "silvasim/fields/memory_raster.h"

namespace silvasim::fields {

namespace {

int CPL_STDCALL stop_when_interrupted(double, const char*, void*) { return base::interrupted() ? 0 : 1; }

// A lattice of points over a box, rim included.
void lattice(const base::Box& box, int steps, std::vector<double>& x, std::vector<double>& y) {
  for (int j = 0; j <= steps; ++j) {
    for (int i = 0; i <= steps; ++i) {
      x.push_back((box.west * (steps - i) + box.east * i) / steps);
      y.push_back((box.south * (steps - j) + box.north * j) / steps);
    }
  }
}

}  // namespace

PixelMap::PixelMap(const Georeference& grid, const Crs& scene_crs) : grid_(grid), to_file_(scene_crs, grid.crs) {}

void PixelMap::apply(std::vector<double>& x, std::vector<double>& y) const {
  to_file_.apply(x, y);
  const auto& t = grid_.transform;
  const double determinant = t[1] * t[5] - t[2] * t[4];
  const double period = is_geographic(grid_.crs) ? 360.0 : 0.0;
  const base::Box own = own_extent(grid_);
  for (std::size_t i = 0; i < x.size(); ++i) {
    // A grid of degrees may be numbered from 0 to 360, or reach over the date line.
    if (period > 0 && x[i] < own.west && x[i] + period <= own.east) x[i] += period;
    if (period > 0 && x[i] > own.east && x[i] - period >= own.west) x[i] -= period;
    const double dx = x[i] - t[0], dy = y[i] - t[3];
    x[i] = (dx * t[5] - dy * t[2]) / determinant;
    y[i] = (dy * t[1] - dx * t[4]) / determinant;
  }
}

PixelBounds PixelMap::bounds(const base::Box& window) const {
  std::vector<double> x, y;
  lattice(window, 64, x, y);
  apply(x, y);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  PixelBounds result{false, infinity, -infinity, infinity, -infinity};
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
    result.any = true;
    result.least_column = std::min(result.least_column, x[i]);
    result.most_column = std::max(result.most_column, x[i]);
    result.least_row = std::min(result.least_row, y[i]);
    result.most_row = std::max(result.most_row, y[i]);
  }
  return result;
}

CellSize PixelMap::cell_size(const base::Box& window) const {
  // Of the points inside the file take the one nearest to the window's middle; ask how fast the pixels run there.
  std::vector<double> x, y;
  lattice(window, 64, x, y);
  std::vector<double> column = x, row = y;
  apply(column, row);
  const base::Point middle{(window.west + window.east) / 2, (window.south + window.north) / 2};
  double best = std::numeric_limits<double>::infinity();
  base::Point place = middle;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(column[i] >= 0 && column[i] <= grid_.columns && row[i] >= 0 && row[i] <= grid_.rows)) continue;
    const double dx = x[i] - middle.x, dy = y[i] - middle.y;
    if (dx * dx + dy * dy < best) {
      best = dx * dx + dy * dy;
      place = {x[i], y[i]};
    }
  }
  const double step = std::max(window.width(), window.height()) / 256;
  std::vector<double> px = {place.x - step, place.x + step, place.x, place.x};
  std::vector<double> py = {place.y, place.y, place.y - step, place.y + step};
  apply(px, py);
  const auto size = [&](std::size_t a, std::size_t b) {
    const double dx = px[b] - px[a], dy = py[b] - py[a];
    return 2 * step / std::sqrt(dx * dx + dy * dy);
  };
  const CellSize result{size(0, 1), size(2, 3)};
  if (!(result.width > 0 && result.height > 0) || !std::isfinite(result.width + result.height)) {
    throw base::Error("a raster in " + name_of(grid_.crs) + " cannot be brought to the scene");
  }
  return result;
}

bool lies_alike(const Georeference& grid, const Crs& scene_crs) {
  if (same(grid.crs, scene_crs)) return true;
  if (!grid.crs || !scene_crs || is_geographic(grid.crs) || is_geographic(scene_crs)) return false;
  std::vector<double> x, y;
  lattice(own_extent(grid), 8, x, y);
  const std::vector<double> before_x = x, before_y = y;
  Transformation(grid.crs, scene_crs).apply(x, y);
  const double slack_x = 1e-4 * std::abs(grid.transform[1]), slack_y = 1e-4 * std::abs(grid.transform[5]);
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(std::abs(x[i] - before_x[i]) <= slack_x && std::abs(y[i] - before_y[i]) <= slack_y)) return false;
  }
  return true;
}

void warp(std::vector<float>& cells, const Georeference& grid, config::FieldKind kind, const Crs& scene_crs,
          Raster& raster) {
  GdalLog log;
  const double missing = std::numeric_limits<double>::quiet_NaN();
  const Dataset source = memory_raster(cells, grid.columns, grid.rows);
  std::array<double, 6> transform = grid.transform;
  source->SetGeoTransform(transform.data());
  if (grid.crs) source->SetSpatialRef(grid.crs.get());
  source->GetRasterBand(1)->SetNoDataValue(missing);

  raster.values.assign(static_cast<std::size_t>(raster.columns) * static_cast<std::size_t>(raster.rows),
                       static_cast<float>(missing));
  const Dataset target = memory_raster(raster.values, raster.columns, raster.rows);
  transform = {raster.west, raster.cell_width, 0, raster.north, 0, -raster.cell_height};
  target->SetGeoTransform(transform.data());
  if (scene_crs) target->SetSpatialRef(scene_crs.get());
  target->GetRasterBand(1)->SetNoDataValue(missing);

  // Positions come right to a two-hundredth of a cell, in a tenth of the time of exact ones.
  constexpr double tolerance_cells = 0.005;
  const auto destroy_exact = [](void* t) { GDALDestroyGenImgProjTransformer(t); };
  const std::unique_ptr<void, decltype(destroy_exact)> exact(
      GDALCreateGenImgProjTransformer2(source.get(), target.get(), nullptr), destroy_exact);
  if (!exact)
    throw base::Error("a raster in " + name_of(grid.crs) + " cannot be brought to the scene: " + log.reason());
  const auto destroy_quick = [](void* t) { GDALDestroyApproxTransformer(t); };
  const std::unique_ptr<void, decltype(destroy_quick)> quick(
      GDALCreateApproxTransformer(GDALGenImgProjTransform, exact.get(), tolerance_cells), destroy_quick);

  const std::unique_ptr<GDALWarpOptions, decltype(&GDALDestroyWarpOptions)> options(GDALCreateWarpOptions(),
                                                                                    GDALDestroyWarpOptions);
  options->hSrcDS = source.get();
  options->hDstDS = target.get();
  options->eResampleAlg = kind == config::FieldKind::class_code ? GRA_NearestNeighbour : GRA_Bilinear;
  options->eWorkingDataType = GDT_Float32;
  options->dfWarpMemoryLimit = 256e6;
  options->pfnTransformer = GDALApproxTransform;
  options->pTransformerArg = quick.get();
  options->pfnProgress = stop_when_interrupted;
  GDALWarpInitDefaultBandMapping(options.get(), 1);
  GDALWarpInitSrcNoDataReal(options.get(), missing);
  GDALWarpInitDstNoDataReal(options.get(), missing);
  options->papszWarpOptions = CSLSetNameValue(options->papszWarpOptions, "INIT_DEST", "NO_DATA");
  // The kernel must not widen: a hair's breadth of a finer grid would otherwise blur the cells.
  options->papszWarpOptions = CSLSetNameValue(options->papszWarpOptions, "XSCALE", "1");
  options->papszWarpOptions = CSLSetNameValue(options->papszWarpOptions, "YSCALE", "1");
  options->papszWarpOptions = CSLSetNameValue(options->papszWarpOptions, "SOURCE_EXTRA", "4");

  GDALWarpOperation operation;
  const bool good = operation.Initialize(options.get()) == CE_None &&
                    operation.ChunkAndWarpImage(0, 0, raster.columns, raster.rows) == CE_None;
  if (base::interrupted()) throw base::Cancelled();
  if (!good) throw base::Error("a raster in " + name_of(grid.crs) + " cannot be brought to the scene: " + log.reason());
}

}  // namespace silvasim::fields
