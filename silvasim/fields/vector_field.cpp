#include "silvasim/fields/vector_field.h"

#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "silvasim/base/error.h"
#include "silvasim/fields/features.h"
#include "silvasim/fields/frame.h"
#include "silvasim/fields/gdal_log.h"
#include "silvasim/fields/memory_raster.h"

namespace silvasim::fields {

namespace {

using config::VectorMeasure;

constexpr double farthest_m = 200'000;  // distances end here
constexpr int rim_cells = 2;            // around the extent, so that bilinear reading is whole up to its rim

double cell_size(const config::FieldSettings& field, const Frame& frame) {
  const double longer = std::max(frame.extent.width(), frame.extent.height());
  const double cell = field.resolution_m > 0 ? field.resolution_m : std::max(1.0, longer / 2000);
  const double cells = (frame.extent.width() / cell + 2 * rim_cells) * (frame.extent.height() / cell + 2 * rim_cells);
  if (cells > most_field_cells) {
    fail_at(
        field,
        fmt::format("a resolution of {:g} m would take {:.0f} cells, more than {:.0f}; {:.3g} m are possible", cell,
                    cells, most_field_cells, std::ceil(cell * std::sqrt(cells / most_field_cells) * 1.01 * 100) / 100));
  }
  return cell;
}

Raster blank(const Frame& frame, double cell, int rim, float value) {
  Raster raster;
  raster.cell_width = raster.cell_height = cell;
  raster.columns = static_cast<int>(std::ceil(frame.extent.width() / cell)) + 2 * rim;
  raster.rows = static_cast<int>(std::ceil(frame.extent.height() / cell)) + 2 * rim;
  raster.west = frame.extent.west - rim * cell;
  raster.north = frame.extent.north + rim * cell;
  raster.values.assign(static_cast<std::size_t>(raster.columns) * static_cast<std::size_t>(raster.rows), value);
  return raster;
}

// What one layer and one scene have in common.
struct Layer {
  const VectorFile& file;
  const config::FieldSettings& field;
  Crs crs, scene_crs;
};

// A layer for distances may lie beside the scene, but hardly as far as this.
double near_m(const Frame& frame) {
  return std::max(4 * std::max(frame.extent.width(), frame.extent.height()), 10'000.0);
}

// The scene, grown by what may count, must meet the layer; looked at in the layer's CRS, since a layer of the whole
// world has no box in the scene's.
void require_overlap(const Layer& layer, const Frame& frame, double reach_m) {
  const base::Box own = layer.file.extent();
  if (layer.file.budget().exhausted()) {
    throw base::Error("data field \"" + layer.field.name + "\": cannot read \"" + layer.field.path.string() +
                      "\": " + endless_query());
  }
  if (!(own.west <= own.east && own.south <= own.north)) {
    const std::string what = "\"" + layer.field.path.string() + "\" holds no feature with a geometry";
    fail_at(layer.field, layer.field.where.empty() ? what : what + " that fulfils where=\"" + layer.field.where + "\"");
  }
  const base::Box scene = bounds(Transformation(layer.scene_crs, layer.crs), grown(frame.extent, reach_m));
  const bool apart = scene.empty() || own.west > scene.east || own.east < scene.west || own.south > scene.north ||
                     own.north < scene.south;
  if (!apart) return;
  const base::Box in_scene = bounds(Transformation(layer.crs, layer.scene_crs), own);
  const bool known = in_scene.west <= in_scene.east && in_scene.south <= in_scene.north;
  fail_at(layer.field,
          "\"" + layer.field.path.string() + "\" does not overlap the scene: it reaches from " +
              (known ? extent_text(layer.scene_crs, in_scene) : extent_text(layer.crs, own) + " in its own CRS") +
              "; the scene from " + extent_text(layer.scene_crs, frame.extent));
}

BurnCount burn(const Layer& layer, const BurnOptions& options, Raster& raster) {
  return burn_features(layer.file, layer.field, layer.crs, layer.scene_crs, options, raster);
}

// Nothing drawn near the scene may be a fact about the land, but not if the filter keeps nothing or all is broken.
void check_count(const Layer& layer, const BurnCount& count) {
  if (count.burnt > 0) return;
  if (count.skipped > 0) {
    fail_at(layer.field,
            fmt::format("none of the {} features of \"{}\" near the scene has a usable geometry{}", count.skipped,
                        layer.field.path.string(), layer.field.attribute.empty() ? "" : " and a number"));
  }
  if (layer.field.where.empty()) return;
  OGRLayer& ogr = layer.file.layer();
  ogr.ResetReading();
  GdalLog log;
  const std::unique_ptr<OGRFeature> any(ogr.GetNextFeature());
  if (!any)
    fail_at(layer.field,
            "\"" + layer.field.path.string() + "\" holds no feature that fulfils where=\"" + layer.field.where + "\"");
}

// Distances in metres from every cell to the nearest one above zero; -1 where there is none.
std::vector<float> distances(Raster& burnt) {
  GdalLog log;
  std::vector<float> result(burnt.values.size(), -1.0f);
  const Dataset from = memory_raster(burnt.values, burnt.columns, burnt.rows);
  const Dataset to = memory_raster(result, burnt.columns, burnt.rows);
  const std::array<const char*, 4> options = {"VALUES=1", "DISTUNITS=PIXEL", "NODATA=-1", nullptr};
  if (GDALComputeProximity(from->GetRasterBand(1), to->GetRasterBand(1), const_cast<char**>(options.data()), nullptr,
                           nullptr) != CE_None) {
    throw base::Error("distances cannot be computed: " + log.reason());
  }
  to->FlushCache(false);
  for (float& value : result) {
    if (value > 0) value = static_cast<float>(value * burnt.cell_width);
  }
  return result;
}

// The distances of a window with the result's own cells.
void take_all(const Raster& window, Raster& result) {
  const int shift = (window.columns - result.columns) / 2;
  for (int row = 0; row < result.rows; ++row) {
    const auto from = window.values.begin() + static_cast<std::ptrdiff_t>(row + shift) * window.columns + shift;
    std::copy_n(from, result.columns, result.values.begin() + static_cast<std::ptrdiff_t>(row) * result.columns);
  }
}

// Those of a coarser window, where the result is farther than `beyond_m` from everything seen before.
void take_nearer(const Raster& window, double beyond_m, Raster& result) {
  std::vector<double> x, y;
  std::vector<float*> cells;
  for (int row = 0; row < result.rows; ++row) {
    float* const values = result.values.data() + static_cast<std::ptrdiff_t>(row) * result.columns;
    x.clear();
    cells.clear();
    for (int column = 0; column < result.columns; ++column) {
      if (static_cast<double>(values[column]) <= beyond_m) continue;
      x.push_back(result.west + (column + 0.5) * result.cell_width);
      cells.push_back(values + column);
    }
    y.assign(x.size(), result.north - (row + 0.5) * result.cell_height);
    std::vector<float> metres(x.size());
    std::vector<std::uint8_t> none(x.size());
    sample(window, config::FieldKind::value, x, y, metres, none);
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!none[i]) *cells[i] = std::min(*cells[i], metres[i]);
    }
  }
}

// The nearest feature may lie outside the scene. What is found within the margin of the first window is nearest for
// certain; for the rest of the scene windows follow with twice the margin and twice the cell, so that each costs less
// than the one before, however far the nearest feature lies.
Raster distance_field(const Layer& layer, const Frame& frame, double cell, BurnCount& count) {
  const double longer = std::max(frame.extent.width(), frame.extent.height());
  Raster result = blank(frame, cell, rim_cells, std::numeric_limits<float>::infinity());
  double seen_m = 0, margin_m = std::max(longer / 8, 128 * cell);
  for (double step = cell;; step *= 2, seen_m = margin_m, margin_m *= 2) {
    Raster window = blank(frame, step, static_cast<int>(std::ceil(margin_m / step)) + rim_cells, 0);
    count = burn(layer, {.attribute = {}, .line_width_m = 0, .all_touched = true}, window);
    if (count.burnt > 0) {
      window.values = distances(window);
      if (step == cell) {
        take_all(window, result);
      } else {
        take_nearer(window, seen_m, result);
      }
    }
    const float largest = *std::max_element(result.values.begin(), result.values.end());
    if (static_cast<double>(largest) <= margin_m || margin_m >= farthest_m) break;
  }
  for (float& metres : result.values) metres = std::min(metres, static_cast<float>(farthest_m));
  return result;
}

}  // namespace

RasterField load_vector_field(const config::FieldSettings& field, const Frame& frame) {
  const VectorFile file(field);
  const Crs scene_crs = crs_of(frame);
  const Layer layer{file, field, crs_in_scene(field, file.crs(), file.crs_known(), scene_crs), scene_crs};
  const double cell = cell_size(field, frame);
  const bool distance = field.measure == VectorMeasure::distance;
  require_overlap(layer, frame, distance ? near_m(frame) : 0);

  RasterField result;
  BurnCount count;
  if (distance) {
    result.raster = distance_field(layer, frame, cell, count);
  } else {
    const bool inside = field.measure == VectorMeasure::inside;
    result.raster = blank(frame, cell, rim_cells, inside ? 0 : std::numeric_limits<float>::quiet_NaN());
    count = burn(layer,
                 {.attribute = inside ? std::string{} : field.attribute,
                  .line_width_m = field.line_width_m,
                  .all_touched = false},
                 result.raster);
  }
  check_count(layer, count);
  if (field.measure == VectorMeasure::attribute && count.burnt == 0) {
    fail_at(field, "\"" + field.path.string() + "\" has no feature in the scene, so the field has no data anywhere");
  }
  result.source =
      fmt::format("{} layer \"{}\", {}, {} features on {} x {} cells of {:g} m", file.format(), file.layer().GetName(),
                  name_of(layer.crs), count.burnt, result.raster.columns, result.raster.rows, cell);
  if (count.skipped > 0) result.source += fmt::format(", {} unusable features left out", count.skipped);
  return result;
}

}  // namespace silvasim::fields
