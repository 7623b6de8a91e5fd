#include "views.h"

namespace silva_bench {

namespace scene = silvavis::scene;
namespace shade = silvavis::shade;

shade::Camera camera_of(const scene::Scene& scene, std::size_t view) {
  const double side = scene.extent.width();
  const auto ground = [&](double x, double y) { return scene::ground_at(scene.ground, x, y).height_m; };
  shade::Camera camera;
  camera.width = 1920;
  camera.height = 1080;
  if (view == 0) {
    camera.eye = {0, -0.9 * side, 0.75 * side};
    camera.look_at = {0, 0, ground(0, 0)};
    camera.fov_deg = 50;
  } else if (view == 1) {
    camera.eye = {-0.3 * side, -0.3 * side, ground(-0.3 * side, -0.3 * side) + 400};
    camera.look_at = {0.1 * side, 0.1 * side, ground(0, 0)};
    camera.fov_deg = 60;
  } else {
    const double x = 0.02 * side, y = 0.01 * side;
    camera.eye = {x, y, ground(x, y) + 12};
    camera.look_at = {x + 100, y + 60, ground(x + 100, y + 60) + 10};
    camera.fov_deg = 60;
  }
  return camera;
}

}  // namespace silva_bench
