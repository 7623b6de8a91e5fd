// Opens a user's file as vectors and finds the layer.
#pragma once

#include <memory>
#include <string>

#include "silvasim/config/field_settings.h"
#include "silvasim/fields/open.h"
#include "silvasim/fields/sqlite_guard.h"

class OGRLayer;

namespace silvasim::fields {

// What is said of a file whose budget ran out.
inline std::string endless_query() {
  return "its queries take far longer than a file of its size should (a view without end?)";
}

// An open file with its layer. Belongs to the thread that made it, which works under an SqliteBudget while it lives.
class VectorFile {
 public:
  // Opens the file, read-only, chooses the layer and sets its attribute filter. A CSV's points are taken from columns
  // called x and y, lon and lat, easting and northing and the like, or WKT. A lone .shp gets a new index, in memory.
  //
  // Errors: base::ConfigError at the field's place: no such file, no format that Silva reads, no such layer, no
  //   geometry, a `where` that is wrong; base::Error for a damaged file.
  explicit VectorFile(const config::FieldSettings& field);
  VectorFile(const VectorFile&) = delete;
  VectorFile& operator=(const VectorFile&) = delete;
  ~VectorFile();

  OGRLayer& layer() const { return *layer_; }
  const SqliteBudget& budget() const { return budget_; }
  Crs crs() const;  // the user's, else the file's
  bool crs_known() const;
  base::Box extent() const;  // of the layer, in its CRS; empty if it has no features
  std::string format() const;

 private:
  void open();
  void set_where();
  [[noreturn]] void fail_where(const std::string& reason) const;
  void close();

  const config::FieldSettings& field_;
  SqliteBudget budget_;
  bool sqlite_ = false;
  sqlite3* connection_ = nullptr;  // GDAL's to a GeoPackage
  std::string memory_folder_;      // where a lone .shp was copied to; empty: nowhere
  Dataset dataset_;
  OGRLayer* layer_ = nullptr;
};

}  // namespace silvasim::fields
