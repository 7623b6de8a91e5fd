// Rays and cameras that fit a scene.
#include "silvavis/shade/camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "silvasim/base/error.h"
#include "silvasim/base/random.h"

namespace silvavis::shade {
namespace {

using silvasim::base::Error;
using testing::HasSubstr;
using testing::ThrowsMessage;

Camera looking(const V3d& eye, const V3d& at, double fov_deg = 90, int width = 200, int height = 100) {
  return {eye, at, fov_deg, width, height};
}

void expect_direction(const V3& got, const V3d& wanted) {
  const V3d unit = wanted.normalized();
  EXPECT_NEAR(got.x, unit.x, 1e-6);
  EXPECT_NEAR(got.y, unit.y, 1e-6);
  EXPECT_NEAR(got.z, unit.z, 1e-6);
}

TEST(Camera, MiddleCornersAndHandedness) {
  // To the north, 90 degrees across: the plane at distance 1 reaches from -1 to 1, half as high.
  const Lens lens = lens_of(looking({10, 20, 30}, {10, 25, 30}));
  EXPECT_EQ(ray_through(lens, 0, 0).origin, V3d(10, 20, 30));
  expect_direction(ray_through(lens, 100, 50).direction, {0, 1, 0});
  expect_direction(ray_through(lens, 0, 50).direction, {-1, 1, 0});    // left is west
  expect_direction(ray_through(lens, 200, 0).direction, {1, 1, 0.5});  // up is up, square pixels
  expect_direction(ray_through(lens, 200, 100).direction, {1, 1, -0.5});
}

TEST(Camera, LooksStraightDownWithNorthOnTop) {
  const Lens lens = lens_of(looking({500000.25, 5e6, 1000}, {500000.25, 5e6, 0}));
  expect_direction(ray_through(lens, 100, 50).direction, {0, 0, -1});
  expect_direction(ray_through(lens, 100, 0).direction, {0, 0.5, -1});
  expect_direction(ray_through(lens, 200, 50).direction, {1, 0, -1});
  // Nearly straight down from the south there is no jump.
  const Lens tilted = lens_of(looking({0, -1e-3, 1000}, {0, 0, 0}));
  expect_direction(ray_through(tilted, 200, 50).direction, {1, 1e-6, -1});
  const Lens sky = lens_of(looking({0, 0, 0}, {0, 0, 9}));
  expect_direction(ray_through(sky, 100, 0).direction, {0, 0.5, 1});
  expect_direction(ray_through(sky, 200, 50).direction, {-1, 0, 1});
}

TEST(Camera, RaysAreUnitAndProjectBackToTheirPixels) {
  silvasim::base::Stream stream(1, silvasim::base::Purpose::selection);
  const auto some = [&] { return stream.next_double() * 2000 - 1000; };
  for (int i = 0; i < 200; ++i) {
    const Lens lens =
        lens_of(looking({some(), some(), some()}, {some(), some(), some()}, 5 + 160 * stream.next_double(), 640, 480));
    EXPECT_NEAR(lens.forward.dot(lens.right), 0, 1e-12);
    EXPECT_GE(lens.up.z, 0);
    EXPECT_NEAR(lens.right.z, 0, 1e-12);
    const double x = 640 * stream.next_double(), y = 480 * stream.next_double();
    const CameraRay ray = ray_through(lens, x, y);
    EXPECT_NEAR(ray.direction.length(), 1, 1e-6);
    const PicturePoint point = project(lens, ray.origin + V3d(ray.direction) * 100);
    EXPECT_NEAR(point.x_px, x, 0.01);
    EXPECT_NEAR(point.y_px, y, 0.01);
    EXPECT_GT(point.axis_m, 0);
  }
}

TEST(Camera, FootprintIsTheAngleBetweenTheMiddlePixels) {
  const Lens lens = lens_of(looking({0, 0, 0}, {0, 1, 0}, 60, 1920, 1080));
  const V3d a(ray_through(lens, 960, 540).direction), b(ray_through(lens, 961, 540).direction);
  EXPECT_NEAR(lens.footprint_rad, (a - b).length(), lens.footprint_rad * 1e-3);
}

TEST(Camera, RefusesWhatNoLensCanDo) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([] { lens_of(looking({1, 2, 3}, {1, 2, 3})); }, ThrowsMessage<Error>(HasSubstr("two must be different")));
  EXPECT_THAT([&] { lens_of(looking({nan, 2, 3}, {1, 2, 3})); }, ThrowsMessage<Error>(HasSubstr("finite")));
  for (const double fov : {0.0, -3.0, 180.0, nan}) {
    EXPECT_THAT([&] { lens_of(looking({0, 0, 0}, {1, 2, 3}, fov)); }, ThrowsMessage<Error>(HasSubstr("0.01 to 170")));
  }
  EXPECT_THROW(lens_of(looking({0, 0, 0}, {1, 2, 3}, 60, 0, 10)), Error);
  EXPECT_THROW(lens_of(looking({0, 0, 0}, {1, 2, 3}, 60, 10, 40000)), Error);
}

struct Fit {
  double least_x = 1e9, greatest_x = -1e9, least_y = 1e9, greatest_y = -1e9;
};

Fit seen(const Camera& camera, const SceneBox& box) {
  const Lens lens = lens_of(camera);
  Fit fit;
  for (int corner = 0; corner < 8; ++corner) {
    const PicturePoint p = project(
        lens, V3d(corner & 1 ? box.ground.east : box.ground.west, corner & 2 ? box.ground.north : box.ground.south,
                  corner & 4 ? box.greatest_z_m : box.least_z_m));
    EXPECT_GT(p.axis_m, 0);
    fit.least_x = std::min(fit.least_x, p.x_px);
    fit.greatest_x = std::max(fit.greatest_x, p.x_px);
    fit.least_y = std::min(fit.least_y, p.y_px);
    fit.greatest_y = std::max(fit.greatest_y, p.y_px);
  }
  return fit;
}

TEST(Camera, AFittedCameraSeesTheWholeSceneAndIsAsNearAsItCan) {
  silvasim::base::Stream stream(2, silvasim::base::Purpose::selection);
  for (int i = 0; i < 200; ++i) {
    SceneBox box;
    box.ground = {4e5, 5e6, 4e5 + 10 + 40000 * stream.next_double(), 5e6 + 10 + 40000 * stream.next_double()};
    box.least_z_m = -100 + 3000 * stream.next_double();
    box.greatest_z_m = box.least_z_m + 2000 * stream.next_double();
    FitOptions options;
    options.down_deg = i % 10 == 0 ? 90 : -20 + 109 * stream.next_double();
    options.heading_deg = 720 * stream.next_double() - 360;
    options.fov_deg = 10 + 90 * stream.next_double();
    options.margin = 0.2 * stream.next_double();
    options.width = 300 + static_cast<int>(stream.next_below(1000));
    const Camera camera = fitted_camera(box, options);
    const Fit fit = seen(camera, box);
    const double mx = options.margin * options.width, my = options.margin * options.height;
    EXPECT_GT(fit.least_x, mx - 0.1) << i;
    EXPECT_LT(fit.greatest_x, options.width - mx + 0.1) << i;
    EXPECT_GT(fit.least_y, my - 0.1) << i;
    EXPECT_LT(fit.greatest_y, options.height - my + 0.1) << i;
    // Nearer is impossible: in one of the axes it touches both margins.
    const bool wide = fit.least_x < mx + 0.5 && fit.greatest_x > options.width - mx - 0.5;
    const bool high = fit.least_y < my + 0.5 && fit.greatest_y > options.height - my - 0.5;
    EXPECT_TRUE(wide || high) << i;
  }
}

TEST(Camera, TheDefaultLooksFromTheSouthAndTheBirdStraightDown) {
  SceneBox box;
  box.ground = {1000, 2000, 4000, 5000};
  box.greatest_z_m = 100;
  const Camera camera = fitted_camera(box);
  EXPECT_LT(camera.eye.y, 2000);
  EXPECT_NEAR(camera.eye.x, 2500, 1e-6);
  const V3d along = (camera.look_at - camera.eye).normalized();
  EXPECT_NEAR(std::asin(-along.z) * 57.29578, 27, 1e-4);
  const Lens bird = lens_of(bird_view(box));
  EXPECT_EQ(bird.forward, V3d(0, 0, -1));
  EXPECT_GT(project(bird, V3d(4000, 3500, 0)).x_px, project(bird, V3d(1000, 3500, 0)).x_px);
  EXPECT_LT(project(bird, V3d(2500, 5000, 0)).y_px, project(bird, V3d(2500, 2000, 0)).y_px);
  EXPECT_THROW(fitted_camera(SceneBox{}), Error);
}

}  // namespace
}  // namespace silvavis::shade
