// The land around a scene, which nobody measured: what its border shows goes on outwards, evens out, and ends as a plain in the haze.
//
// Not geometry but a function of the place: near the border the height of the border's nearest point, farther out a mean over
// ever more of the border, and from `spread_m` on the level of the scene's lowest point, on a round earth. Colours go over soon from the
// border's own to a patchwork of what gentle land in the scene looks like, in the same shares. It bars no light and no sight of the scene but for eyes that stand outside of it.
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

// How much lighter than a Lambertian plain land looks by day, from all sides: woods show their lit crowns to who has the sun behind, and
// their shade to who looks towards it.
struct Views {
  static constexpr std::size_t sides = 12, heights = 4;
  std::array<Rgb, sides * heights> shares;  // by height above the horizon, then by side

  Views() { shares.fill(Rgb(1, 1, 1)); }

  static V3 direction(std::size_t number);  // from the land to the eye
  void smooth();                            // over neighbouring sides
  Rgb from(const V3& direction) const;      // interpolated
};

class Surroundings {
 public:
  static constexpr int parts = 64;           // of each side of the border
  static constexpr std::size_t shades = 10;  // of what the land looks like

  Surroundings() = default;  // none

  // `planted`: within it land looks as it does. `colours`: of the land as a whole near its border, part by part, anticlockwise from the
  // south-western corner: 4 * parts. `usual`: what land looks like farther out, equal shares of it from dark to light.
  Surroundings(const scene::Ground& ground, const silvasim::base::Box& planted, const std::vector<Rgb>& colours,
               const std::vector<Rgb>& usual);

  bool empty() const { return around_.empty(); }

  // Under the light of an hour.
  void show_as(const Views& views) { views_ = views; }

  // Reflectance at a place outside of what is planted, for an eye in the direction of `to_eye` whose ray is so wide there.
  Rgb colour_at(double x, double y, const V3& to_eye, float width_m) const;
  double outside_planted(double x, double y) const;

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
  Part mean_near(const silvasim::base::Box& box, double x, double y, double outside_m) const;
  bool cross(const scene::Ground& ground, const accel::Ray& ray, double from_m, double to_m, Point& point) const;
  void show(const scene::Ground& ground, const accel::Ray& ray, Point& point) const;

  silvasim::base::Box box_, planted_;  // of heights, of colours
  double level_m_ = 0, most_m_ = 0, spread_m_ = 0;
  std::vector<Rgb> usual_;
  Rgb usual_mean_{0, 0, 0};
  Views views_;
  std::vector<Part> around_;  // sums from the first part on: 4 * parts + 1
};

}  // namespace silvavis::shade
