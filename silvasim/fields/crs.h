// A coordinate reference system, always with x to the east and y to the north first, and the way from one to another.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "silvasim/base/geometry.h"

class OGRSpatialReference;
class OGRCoordinateTransformation;

namespace silvasim::fields {

// Immutable and shared; empty means local metres, without a place on the earth. Heights are left out: only the
// horizontal part of a compound system is kept.
using Crs = std::shared_ptr<const OGRSpatialReference>;

// From what a user writes ("EPSG:32610", a WKT, a PROJ string), never through a file or an address.
// Errors: base::Error that says what is wrong with the text.
Crs crs_from_text(const std::string& text);
Crs crs_from_gdal(const OGRSpatialReference* reference);  // null, local or engineering systems in metres: empty
Crs wgs84();

std::string wkt_of(const Crs& crs);   // WKT2:2019; empty for local metres
std::string name_of(const Crs& crs);  // "WGS 84 / UTM zone 10N (EPSG:32610)"; "local metres"
bool is_geographic(const Crs& crs);
bool is_in_metres(const Crs& crs);  // projected, with metres on both axes; also local metres
bool same(const Crs& a, const Crs& b);

// Errors: base::Error if there is no way from one to the other (also if exactly one of them is local).
// Threads: a transformation belongs to the thread that made it.
class Transformation {
 public:
  Transformation(const Crs& from, const Crs& to);
  Transformation(Transformation&&) noexcept;
  Transformation& operator=(Transformation&&) noexcept;
  ~Transformation();

  void apply(std::span<double> x, std::span<double> y) const;  // in place; NaN where a point has no image
  std::optional<base::Point> apply(base::Point point) const;
  OGRCoordinateTransformation* gdal() const { return way_.get(); }  // null: the identity

 private:
  struct Destroy {
    void operator()(OGRCoordinateTransformation* way) const;
  };
  std::unique_ptr<OGRCoordinateTransformation, Destroy> way_;
};

// The box around the image of a box: its inside and edges are followed, not its corners alone. Empty if nothing of it
// has an image.
base::Box bounds(const Transformation& way, const base::Box& box);

// "west 585000, south 5180000, east 605000, north 5200000", followed by degrees where the CRS has a place on the earth.
std::string extent_text(const Crs& crs, const base::Box& box);

}  // namespace silvasim::fields
