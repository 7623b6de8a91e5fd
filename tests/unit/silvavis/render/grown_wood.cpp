#include "grown_wood.h"

#include <algorithm>

#include "../accel/made_forest.h"
#include "silvavis/flora.h"

namespace silvavis::testing {

scene::Scene grown_wood(int columns, int triangles) {
  MadeForest made;
  made.columns = made.rows = columns;
  made.shrubs = false;
  made.hills_m = 15;
  auto ecosystem = made_ecosystem(made);
  ecosystem.layers[0].species[0].name = "Fagus sylvatica";
  ecosystem.layers[0].species[1].name = "Picea abies";
  FloraOptions options;
  options.triangles = triangles;
  options.variants = 1;
  const Flora flora = models_of(ecosystem, options);
  return scene::make_scene(std::move(ecosystem), flora.models);
}

RenderOptions small_picture(const scene::Scene& scene, double away_m) {
  RenderOptions options;
  options.camera.eye = {0, -away_m, 320 + 0.45 * away_m};
  options.camera.look_at = {0, 0, 305};
  options.camera.fov_deg = std::min(60.0, 1.1 * scene.extent.width() / away_m * 57.3);
  options.camera.width = 160;
  options.camera.height = 90;
  options.samples = 4;
  options.error = 0;
  return options;
}

}  // namespace silvavis::testing
