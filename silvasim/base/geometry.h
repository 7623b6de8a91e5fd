// Points and boxes in the plane. The scene's frame has x to the east and y to the north, in metres.
#pragma once

#include <algorithm>
#include <limits>

namespace silvasim::base {

struct Point {
  double x = 0;
  double y = 0;

  friend bool operator==(const Point&, const Point&) = default;
};

// A closed, axis-parallel box; the default is empty (least > greatest).
struct Box {
  double west = std::numeric_limits<double>::infinity();
  double south = std::numeric_limits<double>::infinity();
  double east = -std::numeric_limits<double>::infinity();
  double north = -std::numeric_limits<double>::infinity();

  double width() const { return east - west; }
  double height() const { return north - south; }
  bool empty() const { return !(west < east && south < north); }
  bool contains(Point p) const { return p.x >= west && p.x <= east && p.y >= south && p.y <= north; }

  friend bool operator==(const Box&, const Box&) = default;
};

inline Box intersection(const Box& a, const Box& b) {
  return {std::max(a.west, b.west), std::max(a.south, b.south), std::min(a.east, b.east), std::min(a.north, b.north)};
}

inline Box grown(const Box& box, double by) { return {box.west - by, box.south - by, box.east + by, box.north + by}; }

}  // namespace silvasim::base
