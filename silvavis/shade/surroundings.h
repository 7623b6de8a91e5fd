// The land around a scene, which nobody measured: what its border shows goes on outwards, evens out, and ends as a plain in the haze.
//
// Not geometry but a function of the place: near the border the height of the border's nearest point, farther out a mean over
// ever more of the border, and from `spread_m` on the level of the scene's lowest point, on a round earth. Colours likewise, from
// the border's own as seen from above. It bars no light and no sight of the scene but for eyes that stand outside of it.
//
// Units: world space, metres. Threads: any. Memory: 13 kB. Cost: 0.5 to 3 µs a ray that leaves the scene towards it; 20 ns for others.
#pragma once

#include <array>
#include <vector>

#include "silvasim/base/geometry.h"
#include "silvavis/accel/tracer.h"
#include "silvavis/base/vector.h"
#include "silvavis/scene/ground.h"

namespace silvavis::shade {

class Surroundings {
 public:
  static constexpr int parts = 64;  // of each side of the border

  Surroundings() = default;  // none

  // `colours`: of the land as a whole near the border, part by part, anticlockwise from the south-western corner: 4 * parts.
  Surroundings(const scene::Ground& ground, const std::vector<Rgb>& colours);

  bool empty() const { return around_.empty(); }

  struct Point {
    double distance_m = 0;
    V3d at{0, 0, 0};
    V3 normal{0, 0, 1};
    Rgb reflectance{0, 0, 0};  // shade of its own plants included
    double outside_m = 0;      // from the border
  };

  // The first point of a ray that met the scene at `most_m`, or nothing (infinite), that lies on the land around. False: none.
  bool meet(const scene::Ground& ground, const accel::Ray& ray, double most_m, Point& point) const;

  double height_at(const scene::Ground& ground, double x, double y) const;

 private:
  struct Part {
    Rgb colour{0, 0, 0};
    float height_m = 0;
  };

  double outside(double x, double y) const;
  Part mean_near(double x, double y, double outside_m) const;
  bool cross(const scene::Ground& ground, const accel::Ray& ray, double from_m, double to_m, Point& point) const;
  void show(const scene::Ground& ground, const accel::Ray& ray, Point& point) const;

  silvasim::base::Box box_;
  double level_m_ = 0, most_m_ = 0, spread_m_ = 0;
  Rgb colour_{0, 0, 0};
  std::vector<Part> around_;  // sums from the first part on: 4 * parts + 1
};

}  // namespace silvavis::shade
