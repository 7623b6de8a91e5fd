// The camera: a pinhole with square pixels, always upright, and cameras that fit a scene.
//
// Pixels: (0, 0) is the picture's upper left corner, pixel (i, j) has its centre at (i + 0.5, j + 0.5).
// Space: `eye` and `look_at` in the scene's frame or in world space; rays come back in the same. Looking straight down
//   or up, the picture's upper edge is to the north.
// Errors: base::Error that names what is wrong (eye and look_at are one point, a field of view that no lens has).
// Threads: plain values. Cost: a ray about 10 ns.
#pragma once

#include "silvasim/base/geometry.h"
#include "silvavis/base/vector.h"

namespace silvavis::shade {

inline constexpr int most_side_px = 32768;  // what silvavis::image can write

struct Camera {
  V3d eye{0, 0, 0};
  V3d look_at{0, 1, 0};
  double fov_deg = 60;  // horizontal, 0.01 to 170
  int width = 1920;
  int height = 1080;

  friend bool operator==(const Camera&, const Camera&) = default;
};

// A camera made ready for its rays.
struct Lens {
  V3d eye;
  V3d forward, right, up;     // unit vectors
  double pixel = 0;           // side of a pixel on the plane at distance 1
  double centre_x, centre_y;  // where the axis meets the picture
  double footprint_rad = 0;   // angle that the middle pixel spans; those farther out span less
};

struct CameraRay {
  V3d origin;
  V3 direction;  // unit
};

Lens lens_of(const Camera& camera);
CameraRay ray_through(const Lens& lens, double x_px, double y_px);

// Where a point is in the picture, and how far along the axis; behind the eye `axis_m` is negative and x, y mean nothing.
struct PicturePoint {
  double x_px, y_px, axis_m;
};
PicturePoint project(const Lens& lens, const V3d& point);

// A scene's extent, in the frame that the camera shall have.
struct SceneBox {
  silvasim::base::Box ground;
  double least_z_m = 0;  // of terrain and plants
  double greatest_z_m = 0;
};

struct FitOptions {
  double down_deg = 27;    // how steeply it looks down, -89 to 90
  double heading_deg = 0;  // where to: clockwise from north, so that 0 looks from the south
  double fov_deg = 50;
  double margin = 0.03;  // of the picture's width and height, free on each side
  int width = 1920;
  int height = 1080;
};

// The nearest camera with that direction that has the whole box in view.
Camera fitted_camera(const SceneBox& box, const FitOptions& options = {});

// The whole scene from above, north up, through a long lens: almost a map.
Camera bird_view(const SceneBox& box, int width = 1920, int height = 1080);

}  // namespace silvavis::shade
