#include "silvavis/shade/camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "silvasim/base/error.h"

namespace silvavis::shade {

namespace {

constexpr double radians = 0.017453292519943295;

[[noreturn]] void fail(const std::string& what) { throw silvasim::base::Error("camera: " + what); }

bool finite(const V3d& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// The two axes of the picture. Up is away from the ground; where there is no such direction, the north.
void aim(Lens& lens) {
  const V3d level(lens.forward.x, lens.forward.y, 0);
  // Below this a rounded look_at would turn the picture.
  constexpr double straight = 1e-9;
  if (level.length() < straight) {
    lens.right = V3d(1, 0, 0);
    lens.forward = V3d(0, 0, lens.forward.z < 0 ? -1 : 1);
    // Looking up, north stays on top and east moves to the left, as on a map of stars.
    if (lens.forward.z > 0) lens.right = V3d(-1, 0, 0);
  } else {
    lens.right = V3d(level.y, -level.x, 0).normalized();
  }
  lens.up = lens.right.cross(lens.forward);
}

void check_picture(double fov_deg, int width, int height) {
  if (!(fov_deg >= 0.01 && fov_deg <= 170)) {
    fail(fmt::format("the field of view is {} degrees; it can be 0.01 to 170", fov_deg));
  }
  if (width < 1 || height < 1 || width > most_side_px || height > most_side_px) {
    fail(fmt::format("the picture has {} x {} pixels; each side can have 1 to {}", width, height, most_side_px));
  }
}

}  // namespace

Lens lens_of(const Camera& camera) {
  check_picture(camera.fov_deg, camera.width, camera.height);
  if (!finite(camera.eye) || !finite(camera.look_at)) fail("the eye and what it looks at must be finite numbers");
  const V3d along = camera.look_at - camera.eye;
  const double distance_m = along.length();
  if (!(distance_m > 0)) fail("the eye is where it looks at; the two must be different points");
  if (!std::isfinite(distance_m)) fail("the eye is too far from what it looks at");
  Lens lens;
  lens.eye = camera.eye;
  lens.forward = along / distance_m;
  aim(lens);
  lens.pixel = 2 * std::tan(camera.fov_deg / 2 * radians) / camera.width;
  lens.centre_x = camera.width / 2.0;
  lens.centre_y = camera.height / 2.0;
  lens.footprint_rad = 2 * std::atan(lens.pixel / 2);
  return lens;
}

CameraRay ray_through(const Lens& lens, double x_px, double y_px) {
  const double x = (x_px - lens.centre_x) * lens.pixel, y = (lens.centre_y - y_px) * lens.pixel;
  const V3d along = lens.forward + lens.right * x + lens.up * y;
  return {lens.eye, V3(along / std::sqrt(1 + x * x + y * y))};
}

PicturePoint project(const Lens& lens, const V3d& point) {
  const V3d from_eye = point - lens.eye;
  const double axis_m = from_eye.dot(lens.forward);
  const double scale = 1 / (axis_m * lens.pixel);
  return {lens.centre_x + from_eye.dot(lens.right) * scale, lens.centre_y - from_eye.dot(lens.up) * scale, axis_m};
}

Camera fitted_camera(const SceneBox& box, const FitOptions& options) {
  check_picture(options.fov_deg, options.width, options.height);
  if (!(options.down_deg >= -89 && options.down_deg <= 90) || !std::isfinite(options.heading_deg)) {
    fail("a fitted camera looks between 89 degrees up and 90 degrees down");
  }
  if (!(options.margin >= 0 && options.margin < 0.45)) fail("the margin of a fitted camera is 0 to 0.45");
  const silvasim::base::Box& ground = box.ground;
  if (ground.empty() || !(box.least_z_m <= box.greatest_z_m) || !finite({ground.west, ground.south, box.least_z_m}) ||
      !finite({ground.east, ground.north, box.greatest_z_m})) {
    fail("the scene has no extent to look at");
  }
  const V3d middle((ground.west + ground.east) / 2, (ground.south + ground.north) / 2,
                   (box.least_z_m + box.greatest_z_m) / 2);
  // A round angle gives exact axes where it should.
  const double heading = options.heading_deg * radians, down = options.down_deg * radians;
  const bool straight_down = options.down_deg == 90;
  Lens lens;
  lens.forward = straight_down
                     ? V3d(0, 0, -1)
                     : V3d(std::sin(heading) * std::cos(down), std::cos(heading) * std::cos(down), -std::sin(down));
  aim(lens);

  // A corner with coordinates (a, b) across and f along the axis is in view where |a - x| <= tangent * (f - eye). The
  // extremes of a - tangent f and -a - tangent f over the corners give the nearest eye, each axis by itself.
  const double inside = 1 - 2 * options.margin;
  const double across = std::tan(options.fov_deg / 2 * radians) * inside;
  const double tangents[2] = {across, across * options.height / options.width};
  const V3d axes[2] = {lens.right, lens.up};
  double sides[2] = {0, 0}, eye_along = std::numeric_limits<double>::infinity();
  double nearest_along = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 2; ++axis) {
    double plus = -std::numeric_limits<double>::infinity(), minus = plus;
    for (int corner = 0; corner < 8; ++corner) {
      const V3d point = V3d(corner & 1 ? ground.east : ground.west, corner & 2 ? ground.north : ground.south,
                            corner & 4 ? box.greatest_z_m : box.least_z_m) -
                        middle;
      const double a = point.dot(axes[axis]), f = point.dot(lens.forward);
      plus = std::max(plus, a - tangents[axis] * f);
      minus = std::max(minus, -a - tangents[axis] * f);
      nearest_along = std::min(nearest_along, f);
    }
    sides[axis] = (plus - minus) / 2;
    eye_along = std::min(eye_along, -(plus + minus) / (2 * tangents[axis]));
  }
  eye_along = std::min(eye_along, nearest_along - 1);  // a metre at least before the box
  Camera camera;
  camera.eye = middle + lens.right * sides[0] + lens.up * sides[1] + lens.forward * eye_along;
  camera.look_at = camera.eye + lens.forward * -eye_along;
  if (straight_down) {  // sums of large numbers must not tilt it
    camera.look_at.x = camera.eye.x;
    camera.look_at.y = camera.eye.y;
  }
  camera.fov_deg = options.fov_deg;
  camera.width = options.width;
  camera.height = options.height;
  return camera;
}

Camera bird_view(const SceneBox& box, int width, int height) {
  FitOptions options;
  options.down_deg = 90;
  options.fov_deg = 20;
  options.width = width;
  options.height = height;
  return fitted_camera(box, options);
}

}  // namespace silvavis::shade
