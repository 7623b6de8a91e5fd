// Longitude and latitude of many scene points, and what the scene's CRS is called.
//
// The CRS is asked at the nodes of a net about a kilometre wide; between them quadratic interpolation is exact to a
// tenth of a millimetre, so that millions of plants cost milliseconds. Errors: base::Error where the CRS cannot be
// read. Threads: construct on one, ask from any.
#pragma once

#include <string>
#include <vector>

#include "silvasim/base/geometry.h"

namespace silvasim::exports {

class Geographic {
 public:
  // `wkt` empty: local metres, without a place on the earth.
  Geographic(const std::string& wkt, const base::Box& box);

  bool known() const { return !longitude_.empty(); }
  // {longitude, latitude} in degrees of WGS 84, NaN where the point has none. Points lie in the box, or nearly.
  base::Point at(base::Point point) const;

 private:
  base::Box box_;
  int columns_ = 0, rows_ = 0;  // nodes, odd
  std::vector<double> longitude_, latitude_;
};

// "WGS 84 / UTM zone 10N (EPSG:32610)"; "local metres" where the WKT is empty, "unknown CRS" where nobody can read it.
std::string crs_name(const std::string& wkt);

}  // namespace silvasim::exports
