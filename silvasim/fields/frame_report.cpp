// How true the frame is to the ground, by GeographicLib; positions by PROJ.
#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/LocalCartesian.hpp>
#include <GeographicLib/MGRS.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <algorithm>
#include <cmath>

#include "silvasim/fields/frame.h"

namespace silvasim::fields {

namespace {

struct Ways {
  std::string wkt;
  std::optional<Transformation> to_degrees, from_degrees;
};

// Building a transformation costs milliseconds, using it microseconds: the last one of a thread is kept.
const Ways& ways_of(const Frame& frame) {
  thread_local Ways ways;
  if (ways.wkt != frame.crs_wkt) {
    const Crs crs = crs_of(frame);
    ways = {frame.crs_wkt, Transformation(crs, wgs84()), Transformation(wgs84(), crs)};
  }
  return ways;
}

std::string mgrs_of(GeographicPoint p) {
  int zone = 0;
  bool north = false;
  double x = 0, y = 0;
  std::string name;
  try {
    GeographicLib::UTMUPS::Forward(p.latitude_deg, p.longitude_deg, zone, north, x, y);
    GeographicLib::MGRS::Forward(zone, north, x, y, p.latitude_deg, 2, name);
  } catch (const GeographicLib::GeographicErr&) {
    return {};
  }
  return name;
}

}  // namespace

std::optional<GeographicPoint> geographic_from_scene(const Frame& frame, base::Point point) {
  if (frame.crs_wkt.empty()) return std::nullopt;
  const auto degrees = ways_of(frame).to_degrees->apply(point);
  if (!degrees) return std::nullopt;
  return GeographicPoint{degrees->y, degrees->x};
}

std::optional<base::Point> scene_from_geographic(const Frame& frame, GeographicPoint point) {
  if (frame.crs_wkt.empty()) return std::nullopt;
  return ways_of(frame).from_degrees->apply({point.longitude_deg, point.latitude_deg});
}

FrameReport report_frame(const Frame& frame) {
  FrameReport report;
  const base::Box& box = frame.extent;
  const base::Point middle{(box.west + box.east) / 2, (box.south + box.north) / 2};
  report.centre = geographic_from_scene(frame, middle);
  if (!report.centre) return report;
  report.south_west = geographic_from_scene(frame, {box.west, box.south});
  report.north_east = geographic_from_scene(frame, {box.east, box.north});
  report.mgrs = mgrs_of(*report.centre);

  // The bearing of grid north: of a short step up the grid.
  const GeographicLib::Geodesic& earth = GeographicLib::Geodesic::WGS84();
  const double step = std::min({100.0, box.width() / 4, box.height() / 4});
  double azimuth = 0, ignored = 0;
  if (const auto up = geographic_from_scene(frame, {middle.x, middle.y + step})) {
    earth.Inverse(report.centre->latitude_deg, report.centre->longitude_deg, up->latitude_deg, up->longitude_deg,
                  azimuth, ignored);
    report.convergence_deg = azimuth;
  }

  // Compare short grid steps with the ground, along both axes, on a lattice over the extent.
  constexpr int steps = 8;
  report.least_scale = 1e300;
  report.most_scale = 0;
  for (int j = 0; j <= steps; ++j) {
    for (int i = 0; i <= steps; ++i) {
      const base::Point p{box.west + box.width() * i / steps, box.south + box.height() * j / steps};
      const auto here = geographic_from_scene(frame, p);
      for (const base::Point q : {base::Point{p.x + step, p.y}, base::Point{p.x, p.y + step}}) {
        const auto there = geographic_from_scene(frame, q);
        if (!here || !there) continue;
        double ground = 0;
        earth.Inverse(here->latitude_deg, here->longitude_deg, there->latitude_deg, there->longitude_deg, ground);
        if (!(ground > 0)) continue;
        report.least_scale = std::min(report.least_scale, step / ground);
        report.most_scale = std::max(report.most_scale, step / ground);
      }
    }
  }
  if (report.most_scale == 0) report.least_scale = report.most_scale = 1;

  // The tangent plane at the middle; the ellipsoid's surface lies below it at the corners.
  const GeographicLib::LocalCartesian plane(report.centre->latitude_deg, report.centre->longitude_deg, 0);
  for (const base::Point corner : {base::Point{box.west, box.south}, base::Point{box.east, box.south},
                                   base::Point{box.west, box.north}, base::Point{box.east, box.north}}) {
    const auto p = geographic_from_scene(frame, corner);
    if (!p) continue;
    double x = 0, y = 0, z = 0;
    plane.Forward(p->latitude_deg, p->longitude_deg, 0, x, y, z);
    report.curvature_drop_m = std::max(report.curvature_drop_m, -z);
  }
  return report;
}

}  // namespace silvasim::fields
