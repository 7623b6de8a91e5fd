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

constexpr int rim_cells = 2;  // around the extent, so that bilinear reading is whole up to its rim

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

// Looks at larger and larger surroundings, until they are as wide as the largest distance found in the scene.
Raster distance_field(const Layer& layer, const Frame& frame, double cell, double reach_m, BurnCount& count) {
  const double longer = std::max(frame.extent.width(), frame.extent.height());
  double margin_m = std::min(reach_m, std::max(longer / 20, 8 * cell));
  Raster result = blank(frame, cell, rim_cells, 0);
  while (true) {
    const int rim = static_cast<int>(std::ceil(margin_m / cell)) + rim_cells;
    Raster burnt = blank(frame, cell, rim, 0);
    count = burn(layer, {.attribute = {}, .all_touched = true}, burnt);
    burnt.values = distances(burnt);

    const int shift = rim - rim_cells;
    double largest = 0;
    for (int row = 0; row < result.rows; ++row) {
      for (int column = 0; column < result.columns; ++column) {
        const float metres = burnt.at(column + shift, row + shift);
        const double known = metres < 0 ? std::numeric_limits<double>::infinity() : metres;
        largest = std::max(largest, known);
        result.values[static_cast<std::size_t>(row) * static_cast<std::size_t>(result.columns) +
                      static_cast<std::size_t>(column)] = static_cast<float>(std::min(known, reach_m));
      }
    }
    if (largest <= margin_m || margin_m >= reach_m) return result;
    margin_m = std::min(reach_m, largest);
  }
}

}  // namespace

RasterField load_vector_field(const config::FieldSettings& field, const Frame& frame) {
  const VectorFile file(field);
  const Crs scene_crs = crs_of(frame);
  const Layer layer{file, field, crs_in_scene(field, file.crs(), file.crs_known(), scene_crs), scene_crs};
  const double cell = cell_size(field, frame);
  const double longer = std::max(frame.extent.width(), frame.extent.height());
  double reach_m = std::max(longer / 2, 1000.0);
  // A fine grid of a small scene must not become huge by its surroundings.
  const double most_side_cells = std::sqrt(most_field_cells);
  reach_m = std::min(reach_m, std::max(longer / 20, (most_side_cells * cell - longer) / 2));
  require_overlap(layer, frame, field.measure == VectorMeasure::distance ? reach_m : 0);

  RasterField result;
  BurnCount count;
  if (field.measure == VectorMeasure::distance) {
    result.raster = distance_field(layer, frame, cell, reach_m, count);
  } else {
    const bool inside = field.measure == VectorMeasure::inside;
    result.raster = blank(frame, cell, rim_cells, inside ? 0 : std::numeric_limits<float>::quiet_NaN());
    count = burn(layer, {.attribute = inside ? std::string{} : field.attribute, .all_touched = false}, result.raster);
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
