#include "silvasim/fields/write_geopackage.h"

#include <cpl_conv.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <memory>
#include <system_error>

#include "silvasim/base/error.h"
#include "silvasim/fields/crs.h"
#include "silvasim/fields/fill_geopackage.h"
#include "silvasim/fields/gdal_log.h"
#include "silvasim/fields/open.h"
#include "silvasim/fields/sqlite_guard.h"

namespace silvasim::fields {

namespace {

// Sets an option of GDAL on this thread while it lives.
class Option {
 public:
  Option(const char* name, const char* value) : name_(name) { CPLSetThreadLocalConfigOption(name, value); }
  Option(const Option&) = delete;
  Option& operator=(const Option&) = delete;
  ~Option() { CPLSetThreadLocalConfigOption(name_, nullptr); }

 private:
  const char* name_;
};

// The file being made, and what may go wrong with it.
class Package {
 public:
  explicit Package(const std::filesystem::path& path) : path_(path) {
    // GDAL makes the file itself and refuses one that is there, be it an empty placeholder.
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
    GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("GPKG");
    dataset_.reset(driver ? driver->Create(path_.c_str(), 0, 0, 0, GDT_Unknown, nullptr) : nullptr);
    require(dataset_ != nullptr);
  }

  ~Package() {
    drop();
    std::error_code ignored;
    for (const char* const rest : {"-journal", "-wal", "-shm"}) std::filesystem::remove(path_.string() + rest, ignored);
  }

  GDALDataset& dataset() { return *dataset_; }

  void require(bool good) const {
    if (!good || log_.failed()) throw base::Error("cannot write \"" + path_.string() + "\": " + log_.reason());
  }

  void close() {
    drop();
    require(true);
  }

 private:
  void drop() {
    const SqliteGate gate;
    dataset_.reset();
  }

  std::filesystem::path path_;
  GdalLog log_;
  Dataset dataset_;
};

void make_layer(Package& package, const PointLayer& layer) {
  const Crs crs = layer.crs_wkt.empty() ? nullptr : crs_from_text(layer.crs_wkt);
  const char* const options[] = {layer.spatial_index ? "SPATIAL_INDEX=YES" : "SPATIAL_INDEX=NO", "GEOMETRY_NAME=geom",
                                 "FID=fid", nullptr};
  OGRLayer* const made = package.dataset().CreateLayer(layer.name.c_str(), const_cast<OGRSpatialReference*>(crs.get()),
                                                       wkbPoint, const_cast<char**>(options));
  package.require(made != nullptr);
  for (const PointColumn& column : layer.columns) {
    OGRFieldDefn definition(column.name.c_str(), column.type == ColumnType::integer  ? OFTInteger
                                                 : column.type == ColumnType::number ? OFTReal
                                                                                     : OFTString);
    package.require(made->CreateField(&definition) == OGRERR_NONE);
  }
}

// The table in which QGIS looks for a layer's style.
void write_style(Package& package, const PointLayer& layer) {
  const char* const options[] = {"FID=id", "ASPATIAL_VARIANT=GPKG_ATTRIBUTES", nullptr};
  OGRLayer* const styles = package.dataset().CreateLayer("layer_styles", nullptr, wkbNone, const_cast<char**>(options));
  package.require(styles != nullptr);
  struct Text {
    const char* name;
    int width;
    std::string value;
  };
  const std::vector<Text> texts = {{"f_table_catalog", 256, ""},
                                   {"f_table_schema", 256, ""},
                                   {"f_table_name", 256, layer.name},
                                   {"f_geometry_column", 256, "geom"},
                                   {"styleName", 30, "silva"},
                                   {"styleQML", 0, layer.style_qml},
                                   {"styleSLD", 0, ""},
                                   {"description", 256, ""},
                                   {"owner", 30, ""},
                                   {"ui", 30, ""}};
  for (const Text& text : texts) {
    OGRFieldDefn definition(text.name, OFTString);
    definition.SetWidth(text.width);
    package.require(styles->CreateField(&definition) == OGRERR_NONE);
  }
  OGRFieldDefn as_default("useAsDefault", OFTInteger);
  as_default.SetSubType(OFSTBoolean);
  package.require(styles->CreateField(&as_default) == OGRERR_NONE);
  OGRFieldDefn updated("update_time", OFTDateTime);
  package.require(styles->CreateField(&updated) == OGRERR_NONE);

  OGRFeature feature(styles->GetLayerDefn());
  for (const Text& text : texts) feature.SetField(text.name, text.value.c_str());
  feature.SetField("useAsDefault", 1);
  feature.SetField("update_time", 2000, 1, 1, 0, 0, 0.0f, 100);
  package.require(styles->CreateFeature(&feature) == OGRERR_NONE);
}

}  // namespace

void write_geopackage(const std::filesystem::path& path, const PointLayer& layer,
                      const std::function<std::optional<PointBlock>()>& next_block) {
  // GDAL makes the empty tables, with all that the format and QGIS want around them.
  {
    const Option no_sync("OGR_SQLITE_SYNCHRONOUS", "OFF"), date("OGR_CURRENT_DATE", "2000-01-01T00:00:00.000Z");
    Package package(path);
    make_layer(package, layer);
    if (!layer.style_qml.empty()) write_style(package, layer);
    package.close();
  }
  fill_geopackage(path, layer, next_block);
}

}  // namespace silvasim::fields
