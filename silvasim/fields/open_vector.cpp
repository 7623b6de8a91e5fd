#include "silvasim/fields/open_vector.h"

#include <cpl_conv.h>
#include <cpl_vsi.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>
#include <system_error>
#include <vector>

#include "silvasim/base/error.h"
#include "silvasim/base/file.h"
#include "silvasim/base/words.h"
#include "silvasim/fields/containment.h"
#include "silvasim/fields/drivers.h"
#include "silvasim/fields/gdal_log.h"

namespace silvasim::fields {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_lone_shape_bytes = std::size_t{512} << 20;

std::uint64_t size_of(const fs::path& path) {
  std::error_code ignored;
  const auto size = fs::file_size(path, ignored);
  return ignored ? 0 : size;
}

bool has_suffix(const fs::path& path, const std::string& suffix) {
  std::string text = path.extension().string();
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  return text == suffix;
}

bool is_lone_shape(const fs::path& path) {
  if (!has_suffix(path, ".shp")) return false;
  std::error_code ignored;
  return !fs::exists(fs::path(path).replace_extension(".shx"), ignored) &&
         !fs::exists(fs::path(path).replace_extension(".SHX"), ignored);
}

// Copies the parts of a shapefile into memory, because GDAL writes the index that it makes beside the .shp.
std::string copy_to_memory(const fs::path& path, std::string& folder) {
  static std::atomic<unsigned> serial{0};
  folder = "/vsimem/silva-shape-" + std::to_string(serial++);
  for (const char* const suffix : {".shp", ".dbf", ".prj", ".cpg"}) {
    const fs::path part =
        fs::path(path).replace_extension(suffix == std::string(".shp") ? path.extension() : fs::path(suffix));
    std::error_code ignored;
    if (!fs::is_regular_file(part, ignored)) continue;
    const std::string bytes = base::read_file(part, most_lone_shape_bytes);
    auto* const copy = static_cast<GByte*>(CPLMalloc(bytes.size() + 1));
    std::copy(bytes.begin(), bytes.end(), copy);
    VSIFCloseL(VSIFileFromMemBuffer((folder + "/shape" + suffix).c_str(), copy, bytes.size(), TRUE));
  }
  return folder + "/shape.shp";
}

std::vector<const char*> open_options(const fs::path& path) {
  if (has_suffix(path, ".csv")) {
    return {"X_POSSIBLE_NAMES=x,x_m,x_coord,lon,long,longitude,easting,east,px,gx",
            "Y_POSSIBLE_NAMES=y,y_m,y_coord,lat,latitude,northing,north,py,gy",
            "GEOM_POSSIBLE_NAMES=wkt,geom,geometry,the_geom",
            "AUTODETECT_TYPE=YES",
            "KEEP_GEOM_COLUMNS=YES",
            nullptr};
  }
  if (has_suffix(path, ".gpkg")) return {"LIST_ALL_TABLES=NO", nullptr};
  return {nullptr};
}

OGRLayer* choose_layer(GDALDataset& dataset, const config::FieldSettings& field) {
  const int count = dataset.GetLayerCount();
  if (count == 0) fail_at(field, "\"" + field.path.string() + "\" holds no layer");
  if (field.layer.empty()) return dataset.GetLayer(0);
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) {
    names.emplace_back(dataset.GetLayer(i)->GetName());
    if (names.back() == field.layer) return dataset.GetLayer(i);
  }
  std::string list;
  for (std::size_t i = 0; i < names.size() && i < 8; ++i) list += (i ? ", \"" : "\"") + names[i] + "\"";
  if (names.size() > 8) list += ", ...";
  fail_at(field, "there is no layer \"" + field.layer + "\" in \"" + field.path.string() + "\", which has " + list +
                     base::did_you_mean(field.layer, names));
}

}  // namespace

VectorFile::VectorFile(const config::FieldSettings& field) : field_(field), budget_(size_of(field.path)) {
  try {
    open();
  } catch (...) {
    close();
    throw;
  }
}

VectorFile::~VectorFile() { close(); }

void VectorFile::open() {
  const config::FieldSettings& field = field_;
  prepare_gdal();
  const std::string shown = "\"" + field.path.string() + "\"";
  std::string name = name_for_gdal(field);
  GdalLog log;
  if (is_lone_shape(field.path)) name = copy_to_memory(field.path, memory_folder_);
  CPLSetThreadLocalConfigOption("SHAPE_RESTORE_SHX", memory_folder_.empty() ? "NO" : "YES");
  const std::vector<const char*> options = open_options(field.path);
  sqlite_ = is_sqlite(field.path);
  std::optional<SqliteGate> gate;
  if (sqlite_) gate.emplace();
  if (sqlite_ && holds_parameter_file(crs_definitions(field.path))) {
    fail_at(field, shown + " defines a CRS that names a file (PARAMETERFILE); a CRS may not");
  }
  dataset_.reset(GDALDataset::Open(name.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_INTERNAL,
                                   vector_driver_names(), options.data(), nullptr));
  if (dataset_ && gate && !gate->guarded()) throw base::Error("SQLite does not let " + shown + " be guarded");
  if (gate) connection_ = gate->connection();
  gate.reset();
  if (!dataset_ && budget_.exhausted()) {
    throw base::Error("data field \"" + field.name + "\": cannot read " + shown + ": " + endless_query());
  }
  if (!dataset_) {
    const bool unknown = !log.failed() || log.reason().find("not recognized") != std::string::npos;
    fail_at(field,
            shown + " cannot be opened as vectors" + (unknown ? "" : ": " + log.reason()) + "; " + readable_vectors());
  }
  layer_ = choose_layer(*dataset_, field);
  if (layer_->GetGeomType() == wkbNone) {
    fail_at(field, "layer \"" + std::string(layer_->GetName()) + "\" of " + shown + " has no geometry" +
                       (has_suffix(field.path, ".csv") ? "; a CSV needs columns x and y, lon and lat, or WKT" : ""));
  }
  if (!field.where.empty()) set_where();
}

// Most formats understand the filter at once. SQLite does so when the first feature is read; what fails then, and does not
// without the filter, is the filter's fault.
void VectorFile::set_where() {
  std::string reason;
  const auto first_is_read = [&](const char* where, GdalLog& log) {
    log.clear();
    if (layer_->SetAttributeFilter(where) != OGRERR_NONE) return false;
    layer_->ResetReading();
    const std::unique_ptr<OGRFeature> feature{layer_->GetNextFeature()};
    if (log.failed() && connection_) reason = last_error(connection_);
    layer_->ResetReading();
    return !log.failed();
  };
  GdalLog log;
  if (first_is_read(field_.where.c_str(), log) || budget_.exhausted()) return;  // who reads on says what is exhausted
  const std::string said = connection_ ? reason : log.reason();
  if (first_is_read(nullptr, log)) fail_where(base::shortened(said, 200));
  layer_->SetAttributeFilter(field_.where.c_str());
}

void VectorFile::fail_where(const std::string& reason) const {
  std::vector<std::string> columns;
  OGRFeatureDefn& definition = *layer_->GetLayerDefn();
  if (const char* const id = layer_->GetFIDColumn(); id && *id) columns.emplace_back(id);
  for (int i = 0; i < definition.GetFieldCount(); ++i) columns.emplace_back(definition.GetFieldDefn(i)->GetNameRef());
  // The word that is unknown, from `no such column: wrong` and `"wrong" not recognised as an available field`.
  std::string what = reason, word;
  if (const std::size_t at = reason.rfind("no such column: "); at != std::string::npos) {
    word = reason.substr(reason.find(':', at) + 2);
  } else if (const std::size_t end = reason.find("\" not recognised"); end != std::string::npos) {
    const std::size_t first = reason.rfind('"', end - 1);
    if (first != std::string::npos) word = reason.substr(first + 1, end - first - 1);
  }
  if (!word.empty()) what = "there is no column \"" + word + "\"";
  std::string list;
  for (std::size_t i = 0; i < columns.size() && i < 12; ++i) list += (i ? ", " : "") + columns[i];
  if (columns.size() > 12) list += ", ...";
  fail_at(field_, "where=\"" + field_.where + "\" cannot be understood: " + what + "; columns are " +
                      (columns.empty() ? "none" : list) + base::did_you_mean(word, columns));
}

void VectorFile::close() {
  GdalLog log;
  {
    std::optional<SqliteGate> gate;
    if (sqlite_) gate.emplace();
    dataset_.reset();
  }
  CPLSetThreadLocalConfigOption("SHAPE_RESTORE_SHX", nullptr);
  if (!memory_folder_.empty()) VSIRmdirRecursive(memory_folder_.c_str());
}

Crs VectorFile::crs() const {
  if (field_.crs == "local") return nullptr;
  if (field_.crs.empty()) return crs_from_gdal(layer_->GetSpatialRef());
  return crs_of_user(field_);
}

bool VectorFile::crs_known() const { return !field_.crs.empty() || crs_from_gdal(layer_->GetSpatialRef()) != nullptr; }

base::Box VectorFile::extent() const {
  GdalLog log;
  OGREnvelope envelope;
  if (layer_->GetExtent(&envelope, TRUE) != OGRERR_NONE) return {};
  const base::Box box{envelope.MinX, envelope.MinY, envelope.MaxX, envelope.MaxY};
  const bool finite =
      std::isfinite(box.west) && std::isfinite(box.south) && std::isfinite(box.east) && std::isfinite(box.north);
  return finite ? box : base::Box{};
}

std::string VectorFile::format() const { return dataset_->GetDriver() ? dataset_->GetDriver()->GetDescription() : ""; }

}  // namespace silvasim::fields
