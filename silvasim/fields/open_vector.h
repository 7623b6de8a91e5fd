// Opens a user's file as vectors and finds the layer.
#pragma once

#include <memory>
#include <string>

#include "silvasim/config/field_settings.h"
#include "silvasim/fields/containment.h"
#include "silvasim/fields/open.h"

class OGRLayer;

namespace silvasim::fields {

// An open file with its layer. Belongs to the thread that made it, which works under an SqliteBudget while it lives.
class VectorFile {
 public:
  // Opens the file, read-only, chooses the layer and sets its attribute filter. A CSV's points are taken from columns
  // called x and y, lon and lat, easting and northing and the like, or WKT. A lone .shp gets its index made anew, in
  // memory.
  //
  // Errors: base::ConfigError at the field's place: no such file, no format that Silva reads, no such layer, no
  // geometry, a
  //   `where` that is wrong; base::Error for a damaged file.
  explicit VectorFile(const config::FieldSettings& field);
  ~VectorFile();

  OGRLayer& layer() const { return *layer_; }
  const SqliteBudget& budget() const { return budget_; }
  Crs crs() const;  // the user's, else the file's
  bool crs_known() const;
  base::Box extent() const;  // of the layer, in its CRS; empty if it has no features
  std::string format() const;

 private:
  const config::FieldSettings& field_;
  SqliteBudget budget_;
  std::string memory_folder_;  // where a lone .shp was copied to; empty: nowhere
  Dataset dataset_;
  OGRLayer* layer_ = nullptr;
};

}  // namespace silvasim::fields
