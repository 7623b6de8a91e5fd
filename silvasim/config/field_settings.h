// What a user may say about the scene and its data fields, as plain structs. The config room fills them from XML; every
// member's meaning and default is what docs/dialect.md says of the attribute of that name.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "silvasim/base/geometry.h"
#include "silvasim/base/place.h"

namespace silvasim::config {

enum class FieldKind {
  value,       // a quantity: bilinear between cell centres
  class_code,  // the code of a class: nearest cell
};

// What a site gets from an Evaluator where its data field has no data.
enum class NoDataPolicy {
  exclude,  // nothing grows there (the default: unknown land stays bare)
  ignore,   // the evaluator says 1, as if it were not there
  fill,     // the field has the value `no_data_fill` there
};

enum class Source { raster, vector, derived };

// What a vector layer turns into.
enum class VectorMeasure {
  inside,     // 1 inside a polygon (or on a line's or point's cell), 0 outside
  attribute,  // the value of the attribute `attribute`; no data where no feature lies
  distance,   // metres to the nearest feature, 0 on it
};

enum class TerrainMeasure {
  slope_deg,   // Horn, degrees
  aspect_deg,  // Horn, degrees clockwise from grid north, the direction the slope faces; flat ground has no data
  northness,   // cos(aspect) * sin(slope): 1 steep and facing north, -1 steep and facing south, 0 flat
  eastness,    // sin(aspect) * sin(slope)
  curvature,   // Laplacian of the terrain, 1/m, Zevenbergen and Thorne 1987; positive in hollows
  tpi,         // topographic position index, metres above the mean of the eight neighbours, or of a disc of `radius_m`
  tri,         // terrain ruggedness index, metres (Riley et al. 1999), as gdaldem computes it by default
  wetness,     // topographic wetness index ln(a / tan(slope)), Beven and Kirkby 1979
  hillshade,   // 0..1, for pictures
};

struct FieldSettings {
  std::string name;
  base::Place place;
  Source source = Source::raster;
  FieldKind kind = FieldKind::value;
  bool terrain = false;  // this field is the ground's height in metres
  NoDataPolicy no_data = NoDataPolicy::exclude;
  double no_data_fill = 0;
  std::optional<double> no_data_value;  // a raw value that means no data, besides what the file declares

  // raster and vector
  std::filesystem::path path;  // resolved against the XML file's folder
  std::string crs;             // overrides the file's, or says it where the file is silent; "" = the file's

  // raster
  int band = 1;
  bool scaled = false;  // the user gave scale or offset; an image without georeference then keeps its raw values
  double scale = 1, offset = 0;  // value = raw * scale + offset, after the file's own scale and offset

  // vector
  std::string layer;  // "" = the first
  std::string where;  // OGR attribute filter
  VectorMeasure measure = VectorMeasure::inside;
  std::string attribute;
  double line_width_m = 0;  // lines are drawn this wide; 0: a cell. Not in the XML: pictures use it (silvavis)
  double resolution_m = 0;  // cell size of the burnt raster; 0: a 2000th of the scene's longer side, 1 m at least

  // derived
  TerrainMeasure derivation = TerrainMeasure::slope_deg;
  std::string of;       // name of the raster field it is derived from; "" = the terrain
  double radius_m = 0;  // tpi: radius of the disc; 0: the eight neighbours
};

// The scene's frame, as far as the user says it.
struct SceneSettings {
  base::Place place;
  std::string crs;                  // "EPSG:32610", a WKT, "local"; "" = the terrain's, or its UTM zone if in degrees
  std::optional<base::Box> extent;  // in the scene's CRS; none: the terrain's (or the first georeferenced raster's)
  std::optional<base::Box> extent_geographic;  // in degrees of WGS 84 (west = longitude); at most one of the extents
  std::optional<double> width_m,
      height_m;  // with neither extent: a local box from (0,0), or the middle of the terrain's
};

}  // namespace silvasim::config
