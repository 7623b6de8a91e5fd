#include "silvavis/level_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "silvavis/accel/nested.h"
#include "silvavis/shade/surface.h"

namespace silvavis {

namespace {

// One plant on flat land, by the same way as any scene.
scene::Scene lone_plant(const std::shared_ptr<const scene::PlantModel>& model) {
  silvasim::ecosystem::Ecosystem e;
  const double side = std::max(4.0 * static_cast<double>(model->reach_m), 1.0);
  e.extent = {0, 0, side, side};
  silvasim::ecosystem::Layer layer;
  layer.name = "one";
  layer.tile_set.side_m = side;
  layer.tile_set.most_radius_m = layer.tile_set.side_m;
  layer.tile_set.colours = layer.tile_set.variants = 1;
  const auto middle = static_cast<float>(side / 2);
  layer.tile_set.tiles.push_back({{}, {{middle, middle, 1.0f}}});
  layer.tiling = {1, 1, {0}};
  layer.north_west = {0, side};
  silvasim::ecosystem::Species species;
  species.name = "one";
  layer.species.push_back(species);
  layer.plants = {0};
  e.layers.push_back(std::move(layer));
  return scene::make_scene(std::move(e), {{{model}}});
}

V3 direction_of(float azimuth_deg, float elevation_deg) {
  const float a = azimuth_deg * std::numbers::pi_v<float> / 180, h = elevation_deg * std::numbers::pi_v<float> / 180;
  return {std::cos(h) * std::sin(a), std::cos(h) * std::cos(a), std::sin(h)};
}

}  // namespace

double lit_brightness(const std::shared_ptr<const scene::PlantModel>& model) {
  constexpr int side_px = 48;
  const scene::Scene scene = lone_plant(model);
  const auto tracer = accel::make_nested(scene);
  const scene::PlantLayer& layer = scene.layers[0];
  const V3d middle(layer.west + layer.tile_side_m / 2, layer.south + layer.tile_side_m / 2,
                   0.5 * static_cast<double>(model->least.z + model->most.z));
  const float radius = std::max(model->reach_m, 0.5f * (model->most.z - model->least.z)) * 1.05f;
  const shade::Land land;
  double sum = 0;
  std::size_t seen = 0;
  std::vector<accel::Ray> rays(side_px * side_px), sunward;
  std::vector<accel::Hit> hits(rays.size());
  std::vector<shade::SurfacePoint> points;
  std::vector<std::uint8_t> shaded;
  for (const V3& view : {direction_of(0, 15), direction_of(110, 40), direction_of(230, 75)}) {
    const V3 right = V3(0, 0, 1).cross(view).normalized(), up = view.cross(right);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const float x = (static_cast<float>(i % side_px) + 0.5f) / side_px * 2 - 1, y = (static_cast<float>(i / side_px) + 0.5f) / side_px * 2 - 1;
      rays[i].origin = middle + V3d(view * (3 * radius) + right * (x * radius) + up * (y * radius));
      rays[i].direction = -view;
    }
    tracer->nearest(rays, hits);
    for (const V3& sun : {direction_of(60, 30), direction_of(200, 55)}) {
      sunward.clear();
      points.clear();
      for (std::size_t i = 0; i < rays.size(); ++i) {
        if (hits[i].surface != accel::Surface::plant) continue;
        points.push_back(shade::surface_at(scene, land, rays[i], hits[i]));
        accel::Ray ray;
        ray.origin = points.back().at + V3d(points.back().plane) * (points.back().plane.dot(sun) > 0 ? 2e-3 : -2e-3);
        ray.direction = sun;
        sunward.push_back(ray);
      }
      shaded.assign(sunward.size(), 0);
      tracer->occluded(sunward, shaded);
      for (std::size_t k = 0; k < points.size(); ++k) {
        const float facing = points[k].normal.dot(sun);
        const float direct = shaded[k] ? 0.0f : std::abs(facing) * luminance(facing > 0 ? points[k].reflectance : points[k].transmittance);
        // What the sky adds where the sun does not come, about a fifth of its light.
        sum += static_cast<double>(direct + 0.2f * luminance(points[k].reflectance + points[k].transmittance));
      }
      seen += points.size();
    }
  }
  return seen > 0 ? sum / static_cast<double>(seen) : 0;
}

}  // namespace silvavis
