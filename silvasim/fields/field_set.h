// The data fields that describe the place, brought onto one frame.
//
// This is the only room that includes GDAL and GeographicLib.
// Source: Silva 2013, section 4.2.2; docs/reading.md, B3; docs/fields.md.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "silvasim/base/geometry.h"
#include "silvasim/base/progress.h"
#include "silvasim/config/field_settings.h"
#include "silvasim/fields/raster.h"

namespace silvasim::fields {

// The scene's frame: metres, x to the east and y to the north of the CRS, and the box that is planted.
struct Frame {
  std::string crs_wkt;   // WKT2:2019; empty: local metres, without a place on the earth
  std::string crs_name;  // for people: "WGS 84 / UTM zone 10N (EPSG:32610)", "local metres"
  base::Box extent;

  friend bool operator==(const Frame&, const Frame&) = default;
};

struct GeographicPoint {
  double latitude_deg = 0;
  double longitude_deg = 0;
};

// How far the frame is from the true ground over its extent.
struct FrameReport {
  std::optional<GeographicPoint> centre, south_west, north_east;  // WGS 84; none for local metres
  std::string mgrs;                        // MGRS name of the centre to 1 km, empty outside MGRS or for local metres
  double convergence_deg = 0;              // grid north against true north at the centre
  double least_scale = 1, most_scale = 1;  // grid length / ground length over the extent
  double curvature_drop_m = 0;             // how far the earth drops below the tangent plane at the extent's corner
};

struct Field {
  std::string name;
  config::FieldKind kind = config::FieldKind::value;  // how sample() reads it; aspect, being an angle, is class_code
  config::NoDataPolicy no_data = config::NoDataPolicy::exclude;
  float no_data_fill = 0;  // for NoDataPolicy::fill
  Raster raster;
  // Provenance.
  std::filesystem::path path;  // empty for derived fields
  std::string sha256;          // of the file at `path`; empty for derived fields
  std::string source;          // one line for reports: "GTiff 884x824 Float32, EPSG:26911, warped"
};

struct FieldSet {
  Frame frame;
  std::vector<Field> fields;  // in the order of the settings
  int terrain = -1;           // index of the field that is the terrain; -1: none, the land is flat
};

// Loads every field, in any CRS and resolution, onto the scene's frame, each with a resolution close to its own.
//
// Errors: base::ConfigError at the field's place for what the user can mend in the XML (file missing, unknown band or
//   attribute, no overlap with the scene: both extents named); base::Error while reading (damaged file).
// Threads: call from one thread; works in parallel inside.
FieldSet load_fields(const config::SceneSettings& scene, const std::vector<config::FieldSettings>& fields,
                     const base::Progress& progress = {});

FrameReport report_frame(const Frame& frame);

// Scene point to WGS 84 and back; none for local metres.
std::optional<GeographicPoint> geographic_from_scene(const Frame& frame, base::Point point);
std::optional<base::Point> scene_from_geographic(const Frame& frame, GeographicPoint point);

}  // namespace silvasim::fields
