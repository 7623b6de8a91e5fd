#include "silvasim/fields/feature_writer.h"

#include <cpl_conv.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <stdexcept>
#include <system_error>

#include "silvasim/base/error.h"
#include "silvasim/fields/crs.h"
#include "silvasim/fields/drivers.h"
#include "silvasim/fields/gdal_log.h"
#include "silvasim/fields/open.h"
#include "silvasim/fields/sqlite_guard.h"

namespace silvasim::fields {

namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  return text;
}

// The caller chose the names, so a wrong one is a mistake in the program.
void check(const PointLayer& layer) {
  std::set<std::string> names = {"fid", "geom", "x", "y"};
  if (layer.name.empty()) throw std::logic_error("a layer of points needs a name");
  for (const PointColumn& column : layer.columns) {
    if (column.name.empty() || !names.insert(lower(column.name)).second) {
      throw std::logic_error("a layer of points cannot have a column \"" + column.name + "\"");
    }
  }
}

void check(const PointLayer& layer, const PointBlock& block) {
  bool good = block.x.size() == block.y.size() && block.columns.size() == layer.columns.size();
  for (std::size_t i = 0; good && i < block.columns.size(); ++i) {
    const bool number = layer.columns[i].type == ColumnType::number;
    good = std::visit([&](const auto& values) { return values.size() == block.x.size(); }, block.columns[i]) &&
           number == std::holds_alternative<std::span<const double>>(block.columns[i]);
    if (!good || layer.columns[i].type != ColumnType::text) continue;
    const auto words = static_cast<std::int64_t>(layer.columns[i].words.size());
    for (const std::int64_t index : std::get<std::span<const std::int64_t>>(block.columns[i]))
      good = good && index >= -1 && index < words;
  }
  if (!good) throw std::logic_error("a block of points does not fit its layer's columns");
}

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

// A file of points being written through GDAL. Destroyed without close() it leaves what may be half a file.
class PointFile {
 public:
  PointFile(const std::filesystem::path& path, PointFormat format, const PointLayer& layer);
  PointFile(const PointFile&) = delete;
  PointFile& operator=(const PointFile&) = delete;
  ~PointFile() { drop(); }

  void add(const PointBlock& block);  // fits the layer
  void close();                       // writes what is left: the spatial index, the file's end

 private:
  void create();
  void create_layer();
  void write_style();
  void index();
  void drop();
  void require(bool good) const;

  const std::filesystem::path path_;
  const PointFormat format_;
  const PointLayer& settings_;
  // A file that nobody sees yet, and that is thrown away if something fails, need not be synchronised statement by
  // statement; the time stamps that a GeoPackage wants are fixed, so that bytes repeat.
  const Option no_sync_{"OGR_SQLITE_SYNCHRONOUS", "OFF"}, no_journal_{"OGR_SQLITE_JOURNAL", "OFF"};
  const Option date_{"OGR_CURRENT_DATE", "2000-01-01T00:00:00.000Z"};
  GdalLog log_;
  Dataset dataset_;
  OGRLayer* layer_ = nullptr;  // the dataset's
  std::unique_ptr<OGRFeature> feature_;
  GIntBig count_ = 0;
};

PointFile::PointFile(const std::filesystem::path& path, PointFormat format, const PointLayer& layer)
    : path_(path), format_(format), settings_(layer) {
  try {
    create();
  } catch (...) {
    drop();
    throw;
  }
}

void PointFile::create() {
  if (format_ == PointFormat::flatgeobuf && path_.extension() != ".fgb") {
    throw base::Error("cannot write \"" + path_.string() + "\": the name of a FlatGeobuf ends in .fgb");
  }
  // GDAL makes the file itself, and some of its drivers refuse one that is there, be it an empty placeholder.
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
  GDALDriver* const driver =
      GetGDALDriverManager()->GetDriverByName(format_ == PointFormat::geopackage ? "GPKG" : "FlatGeobuf");
  {
    const SqliteGate gate;  // lets Ctrl-C stop a long statement
    dataset_.reset(driver ? driver->Create(path_.c_str(), 0, 0, 0, GDT_Unknown, nullptr) : nullptr);
  }
  require(dataset_ != nullptr);
  create_layer();
  if (format_ != PointFormat::geopackage) return;
  if (!settings_.style_qml.empty()) write_style();
  require(dataset_->StartTransaction() == OGRERR_NONE);
}

void PointFile::create_layer() {
  const Crs crs = settings_.crs_wkt.empty() ? nullptr : crs_from_text(settings_.crs_wkt);
  std::vector<const char*> options;
  if (format_ == PointFormat::geopackage) options = {"SPATIAL_INDEX=NO", "GEOMETRY_NAME=geom", "FID=fid"};
  options.push_back(nullptr);
  layer_ = dataset_->CreateLayer(settings_.name.c_str(), const_cast<OGRSpatialReference*>(crs.get()), wkbPoint,
                                 const_cast<char**>(options.data()));
  require(layer_ != nullptr);
  for (const PointColumn& column : settings_.columns) {
    OGRFieldDefn definition(column.name.c_str(), column.type == ColumnType::integer  ? OFTInteger64
                                                 : column.type == ColumnType::number ? OFTReal
                                                                                     : OFTString);
    require(layer_->CreateField(&definition) == OGRERR_NONE);
  }
  feature_ = std::make_unique<OGRFeature>(layer_->GetLayerDefn());
  feature_->SetGeometryDirectly(new OGRPoint(0, 0));
}

// The table in which QGIS looks for a layer's style.
void PointFile::write_style() {
  const char* const options[] = {"FID=id", "ASPATIAL_VARIANT=GPKG_ATTRIBUTES", nullptr};
  OGRLayer* const styles = dataset_->CreateLayer("layer_styles", nullptr, wkbNone, const_cast<char**>(options));
  require(styles != nullptr);
  struct Text {
    const char* name;
    int width;
    std::string value;
  };
  const std::vector<Text> texts = {{"f_table_catalog", 256, ""},
                                   {"f_table_schema", 256, ""},
                                   {"f_table_name", 256, settings_.name},
                                   {"f_geometry_column", 256, "geom"},
                                   {"styleName", 30, "silva"},
                                   {"styleQML", 0, settings_.style_qml},
                                   {"styleSLD", 0, ""},
                                   {"description", 256, ""},
                                   {"owner", 30, ""},
                                   {"ui", 30, ""}};
  for (const Text& text : texts) {
    OGRFieldDefn definition(text.name, OFTString);
    definition.SetWidth(text.width);
    require(styles->CreateField(&definition) == OGRERR_NONE);
  }
  OGRFieldDefn as_default("useAsDefault", OFTInteger);
  as_default.SetSubType(OFSTBoolean);
  require(styles->CreateField(&as_default) == OGRERR_NONE);
  OGRFieldDefn updated("update_time", OFTDateTime);
  require(styles->CreateField(&updated) == OGRERR_NONE);

  OGRFeature style(styles->GetLayerDefn());
  for (const Text& text : texts) style.SetField(text.name, text.value.c_str());
  style.SetField("useAsDefault", 1);
  style.SetField("update_time", 2000, 1, 1, 0, 0, 0.0f, 100);
  require(styles->CreateFeature(&style) == OGRERR_NONE);
}

void PointFile::add(const PointBlock& block) {
  for (std::size_t i = 0; i < block.x.size(); ++i) {
    // One feature for all points: what is set below overwrites the point before.
    feature_->SetFID(format_ == PointFormat::geopackage ? ++count_ : OGRNullFID);
    if (!std::isfinite(block.x[i]) || !std::isfinite(block.y[i])) {
      feature_->SetGeometryDirectly(nullptr);
    } else if (OGRGeometry* const shape = feature_->GetGeometryRef()) {
      shape->toPoint()->setX(block.x[i]);
      shape->toPoint()->setY(block.y[i]);
    } else {
      feature_->SetGeometryDirectly(new OGRPoint(block.x[i], block.y[i]));
    }
    for (std::size_t k = 0; k < settings_.columns.size(); ++k) {
      const PointColumn& column = settings_.columns[k];
      const int place = static_cast<int>(k);
      if (column.type == ColumnType::number) {
        const double value = std::get<std::span<const double>>(block.columns[k])[i];
        if (std::isfinite(value))
          feature_->SetField(place, value);
        else
          feature_->SetFieldNull(place);
      } else if (column.type == ColumnType::integer) {
        feature_->SetField(place, static_cast<GIntBig>(std::get<std::span<const std::int64_t>>(block.columns[k])[i]));
      } else {
        const std::int64_t word = std::get<std::span<const std::int64_t>>(block.columns[k])[i];
        if (word >= 0)
          feature_->SetField(place, column.words[static_cast<std::size_t>(word)].c_str());
        else
          feature_->SetFieldNull(place);
      }
    }
    require(layer_->CreateFeature(feature_.get()) == OGRERR_NONE);
  }
}

void PointFile::index() {
  const auto quoted = [](const std::string& text) {
    std::string result = "'";
    for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
    return result + "'";
  };
  const std::string sql = "SELECT CreateSpatialIndex(" + quoted(settings_.name) + ", 'geom')";
  dataset_->ReleaseResultSet(dataset_->ExecuteSQL(sql.c_str(), nullptr, nullptr));
  require(true);
}

void PointFile::close() {
  if (format_ == PointFormat::geopackage) {
    if (settings_.spatial_index) index();
    require(dataset_->CommitTransaction() == OGRERR_NONE);
  }
  drop();
  require(true);
}

void PointFile::drop() {
  feature_.reset();
  const SqliteGate gate;
  dataset_.reset();
  std::error_code ignored;
  for (const char* const rest : {"-journal", "-wal", "-shm"}) std::filesystem::remove(path_.string() + rest, ignored);
}

void PointFile::require(bool good) const {
  if (good && !log_.failed()) return;
  if (base::interrupted()) throw base::Cancelled();
  throw base::Error("cannot write \"" + path_.string() + "\": " + log_.reason());
}

}  // namespace

void write_points(const std::filesystem::path& path, PointFormat format, const PointLayer& layer,
                  const std::function<std::optional<PointBlock>()>& next_block, std::size_t count,
                  const base::Progress& progress) {
  prepare_gdal();
  check(layer);
  PointFile file(path, format, layer);
  std::size_t written = 0;
  while (true) {
    base::report(progress, "write", count ? std::min(1.0, double(written) / double(count)) : 0.0);
    const std::optional<PointBlock> block = next_block();
    if (!block) break;
    check(layer, *block);
    file.add(*block);
    written += block->x.size();
  }
  base::report(progress, "index", 0);
  file.close();
}

}  // namespace silvasim::fields
