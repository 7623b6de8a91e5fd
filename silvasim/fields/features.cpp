#include "silvasim/fields/features.h"

#include <gdal_alg.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "silvasim/base/error.h"
#include "silvasim/base/progress.h"
#include "silvasim/fields/gdal_log.h"
#include "silvasim/fields/memory_raster.h"

namespace silvasim::fields {

namespace {

using Geometry = std::unique_ptr<OGRGeometry>;

// Looks at every point once.
class FiniteCheck : public OGRDefaultConstGeometryVisitor {
 public:
  using OGRDefaultConstGeometryVisitor::visit;
  void visit(const OGRPoint* point) override {
    finite = finite && (point->IsEmpty() || (std::isfinite(point->getX()) && std::isfinite(point->getY())));
  }
  bool finite = true;
};

bool is_finite(const OGRGeometry& geometry) {
  FiniteCheck check;
  geometry.accept(&check);
  return check.finite;
}

OGRPolygon rectangle(const base::Box& box) {
  auto ring = std::make_unique<OGRLinearRing>();
  ring->addPoint(box.west, box.south);
  ring->addPoint(box.east, box.south);
  ring->addPoint(box.east, box.north);
  ring->addPoint(box.west, box.north);
  ring->closeRings();
  OGRPolygon polygon;
  polygon.addRingDirectly(ring.release());
  return polygon;
}

base::Box envelope_of(const OGRGeometry& geometry) {
  OGREnvelope e;
  geometry.getEnvelope(&e);
  return {e.MinX, e.MinY, e.MaxX, e.MaxY};
}

bool within(const base::Box& a, const base::Box& b) {
  return a.west >= b.west && a.east <= b.east && a.south >= b.south && a.north <= b.north;
}

// Turns a feature's geometry into one that can be drawn on the scene.
class Cleaner {
 public:
  // `near`: the raster's box in the layer's CRS; empty: unknown, nothing is cut off.
  Cleaner(const Crs& layer_crs, const Crs& scene_crs, const base::Box& near)
      : to_scene_(layer_crs, scene_crs),
        near_(near),
        cut_(near.empty() ? near : grown(near, std::max(near.width(), near.height()))),
        scissors_(near.empty() ? OGRPolygon() : rectangle(cut_)) {}

  bool is_elsewhere(const OGRGeometry& raw) const {
    if (near_.empty() || raw.IsEmpty() || !is_finite(raw)) return false;
    const base::Box box = envelope_of(raw);
    return box.west > near_.east || box.east < near_.west || box.south > near_.north || box.north < near_.south;
  }

  // Null if nothing drawable is left.
  Geometry operator()(const OGRGeometry& raw) const {
    if (raw.IsEmpty() || !is_finite(raw)) return nullptr;
    Geometry geometry(raw.hasCurveGeometry() ? raw.getLinearGeometry() : raw.clone());
    if (!geometry) return nullptr;
    geometry->flattenTo2D();
    geometry->closeRings();
    if (!near_.empty() && !within(envelope_of(*geometry), cut_)) geometry = trimmed(std::move(geometry));
    if (!geometry || geometry->IsEmpty()) return nullptr;
    if (!to_scene_.gdal()) return geometry;
    // A long straight edge in one CRS is a curve in the other.
    if (!near_.empty() && within(envelope_of(*geometry), cut_)) {
      constexpr double pieces = 100;
      geometry->segmentize(std::max(near_.width(), near_.height()) / pieces);
    }
    if (geometry->transform(to_scene_.gdal()) != OGRERR_NONE || !is_finite(*geometry)) return nullptr;
    return geometry;
  }

 private:
  // GEOS cuts valid geometries only; what it cannot mend stays whole.
  Geometry trimmed(Geometry geometry) const {
    Geometry valid(geometry->IsValid() ? nullptr : geometry->MakeValid());
    Geometry cut((valid ? *valid : *geometry).Intersection(&scissors_));
    if (!cut) return geometry;
    return cut;
  }

  Transformation to_scene_;
  base::Box near_, cut_;
  OGRPolygon scissors_;
};

int attribute_index(const VectorFile& file, const config::FieldSettings& field, const std::string& attribute) {
  OGRFeatureDefn& definition = *file.layer().GetLayerDefn();
  std::vector<std::string> numbers;
  for (int i = 0; i < definition.GetFieldCount(); ++i) {
    const OGRFieldType type = definition.GetFieldDefn(i)->GetType();
    if (type == OFTInteger || type == OFTInteger64 || type == OFTReal)
      numbers.emplace_back(definition.GetFieldDefn(i)->GetNameRef());
  }
  const int index = definition.GetFieldIndex(attribute.c_str());
  if (index >= 0 &&
      std::find(numbers.begin(), numbers.end(), definition.GetFieldDefn(index)->GetNameRef()) != numbers.end())
    return index;
  std::string list;
  for (std::size_t i = 0; i < numbers.size() && i < 12; ++i) list += (i ? ", " : "") + numbers[i];
  fail_at(field, (index >= 0 ? "attribute \"" + attribute + "\" is no number"
                             : "there is no attribute \"" + attribute + "\"") +
                     " in \"" + field.path.string() + "\"; numbers are " + (numbers.empty() ? "none" : list) +
                     base::did_you_mean(attribute, numbers));
}

[[noreturn]] void fail_reading(const VectorFile& file, const config::FieldSettings& field, const GdalLog& log) {
  if (base::interrupted()) throw base::Cancelled();
  throw base::Error("data field \"" + field.name + "\": cannot read \"" + field.path.string() +
                    "\": " + (file.budget().exhausted() ? endless_query() : log.reason()));
}

}  // namespace

BurnCount burn_features(const VectorFile& file, const config::FieldSettings& field, const Crs& layer_crs,
                        const Crs& scene_crs, const BurnOptions& options, Raster& raster) {
  GdalLog log;
  OGRLayer& layer = file.layer();
  const int attribute = options.attribute.empty() ? -1 : attribute_index(file, field, options.attribute);

  // Ask for what lies near the raster only. (Not GeoJSON: GDAL's filter stumbles over its open rings.)
  base::Box near = bounds(Transformation(scene_crs, layer_crs), raster.extent());
  if (!near.empty()) {
    near = grown(near, std::max(near.width(), near.height()) / 50);
    if (!file.format().starts_with("GeoJSON")) layer.SetSpatialFilterRect(near.west, near.south, near.east, near.north);
  }
  const Cleaner clean(layer_crs, scene_crs, near);
  const Dataset target = memory_raster(raster.values, raster.columns, raster.rows);
  std::array<double, 6> transform = {raster.west, raster.cell_width, 0, raster.north, 0, -raster.cell_height};
  target->SetGeoTransform(transform.data());

  // What waits to be burnt, all by the same rule.
  std::vector<Geometry> geometries;
  std::vector<double> numbers;
  bool touched = false;
  const auto burn = [&] {
    std::vector<OGRGeometryH> handles;
    for (const Geometry& geometry : geometries) handles.push_back(OGRGeometry::ToHandle(geometry.get()));
    const std::array<const char*, 2> rules = {touched ? "ALL_TOUCHED=TRUE" : "ALL_TOUCHED=FALSE", nullptr};
    const int band = 1;
    if (!handles.empty() &&
        GDALRasterizeGeometries(target.get(), 1, &band, static_cast<int>(handles.size()), handles.data(), nullptr,
                                nullptr, numbers.data(), rules.data(), nullptr, nullptr) != CE_None) {
      fail_reading(file, field, log);
    }
    geometries.clear();
    numbers.clear();
  };

  BurnCount count;
  layer.ResetReading();
  log.clear();
  constexpr std::size_t at_once = 4096;
  while (const std::unique_ptr<OGRFeature> feature{layer.GetNextFeature()}) {
    if (base::interrupted()) throw base::Cancelled();
    const OGRGeometry* const raw = feature->GetGeometryRef();
    double number = 1;
    if (attribute >= 0) {
      number = feature->IsFieldSetAndNotNull(attribute) ? feature->GetFieldAsDouble(attribute) : NAN;
      if (!(std::abs(number) < std::numeric_limits<float>::max())) number = NAN;
    }
    Geometry geometry;
    {
      GdalLog quiet;  // what is wrong with one feature is no reason to give up the others
      if (raw && clean.is_elsewhere(*raw)) continue;
      if (raw && !std::isnan(number)) geometry = clean(*raw);
    }
    if (geometry && geometry->getDimension() == 1 && options.line_width_m > 0) {
      GdalLog quiet;
      geometry.reset(geometry->Buffer(options.line_width_m / 2, 4));
    }
    if (!geometry) {
      ++count.skipped;
      continue;
    }
    ++count.burnt;
    const bool touches = options.all_touched || geometry->getDimension() < 2;
    if (touches != touched) burn();
    touched = touches;
    geometries.push_back(std::move(geometry));
    numbers.push_back(number);
    if (geometries.size() == at_once) burn();
  }
  if (log.failed() || file.budget().exhausted()) fail_reading(file, field, log);
  burn();
  layer.SetSpatialFilter(nullptr);
  return count;
}

}  // namespace silvasim::fields
