#include "silvavis/level_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "silvavis/accel/nested.h"
#include "silvavis/shade/surface.h"

namespace silvavis {

namespace {

// Nine plants on flat land as close as in a wood, by the same way as any scene: they shade each other too.
scene::Scene small_wood(const std::shared_ptr<const scene::PlantModel>& model) {
  silvasim::ecosystem::Ecosystem e;
  const double apart = std::max(2.0 * static_cast<double>(model->reach_m), 0.1), side = 5 * apart;
  e.extent = {0, 0, side, side};
  silvasim::ecosystem::Layer layer;
  layer.name = "wood";
  layer.tile_set.side_m = side;
  layer.tile_set.most_radius_m = side;
  layer.tile_set.colours = layer.tile_set.variants = 1;
  layer.tile_set.tiles.emplace_back();
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      // Rows that are shifted, as plants grow in no grid.
      const double x = (1.5 + i + (j == 1 ? 0.35 : 0.0)) * apart, y = (1.5 + 0.9 * j) * apart;
      layer.tile_set.tiles[0].sites.push_back({static_cast<float>(x), static_cast<float>(y), 1.0f});
    }
  }
  layer.tiling = {1, 1, {0}};
  layer.north_west = {0, side};
  silvasim::ecosystem::Species species;
  species.name = "one";
  layer.species.push_back(species);
  layer.plants.assign(9, 0);
  e.layers.push_back(std::move(layer));
  return scene::make_scene(std::move(e), {{{model}}});
}

V3 direction_of(float azimuth_deg, float elevation_deg) {
  const float a = azimuth_deg * std::numbers::pi_v<float> / 180, h = elevation_deg * std::numbers::pi_v<float> / 180;
  return {std::cos(h) * std::sin(a), std::cos(h) * std::cos(a), std::sin(h)};
}

struct Lamp {
  V3 towards;
  float light;
};
// Two places of the sun, and the sky as nine lamps that together give a fifth of its light on level ground.
const std::vector<Lamp>& sun_and_sky() {
  static const std::vector<Lamp> lamps = [] {
    std::vector<Lamp> all{{direction_of(60, 30), 0.5f}, {direction_of(200, 55), 0.5f}, {direction_of(0, 85), 0.06f}};
    for (int i = 0; i < 8; ++i)
      all.push_back({direction_of(static_cast<float>(45 * i + 20), i % 2 == 0 ? 18.0f : 48.0f), 0.04f});
    return all;
  }();
  return lamps;
}

}  // namespace

double lit_brightness(const std::shared_ptr<const scene::PlantModel>& model) {
  constexpr int side_px = 60;
  const scene::Scene scene = small_wood(model);
  const auto tracer = accel::make_nested(scene);
  const scene::PlantLayer& layer = scene.layers[0];
  const V3d middle(layer.west + layer.tile_side_m / 2, layer.south + layer.tile_side_m * 0.48,
                   0.5 * static_cast<double>(model->least.z + model->most.z));
  const float radius = std::max(3 * model->reach_m, 0.5f * (model->most.z - model->least.z)) * 1.02f;
  const shade::Land land;
  const std::vector<Lamp>& lamps = sun_and_sky();
  double sum = 0;
  std::size_t seen = 0;
  std::vector<accel::Ray> rays(side_px * side_px), sunward;
  std::vector<accel::Hit> hits(rays.size());
  std::vector<shade::SurfacePoint> points;
  std::vector<accel::Hit> met;
  std::vector<std::size_t> askers;
  std::vector<std::uint8_t> shaded;
  for (const V3& view : {direction_of(0, 12), direction_of(110, 30), direction_of(230, 65)}) {
    const V3 right = V3(0, 0, 1).cross(view).normalized(), up = view.cross(right);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const float x = (static_cast<float>(i % side_px) + 0.5f) / side_px * 2 - 1,
                  y = (static_cast<float>(i / side_px) + 0.5f) / side_px * 2 - 1;
      rays[i].origin = middle + V3d(view * (3 * radius) + right * (x * radius) + up * (y * radius));
      rays[i].direction = -view;
    }
    tracer->nearest(rays, hits);
    points.clear();
    met.clear();
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (hits[i].surface != accel::Surface::plant) continue;
      points.push_back(shade::surface_at(scene, land, rays[i], hits[i]));
      met.push_back(hits[i]);
    }
    seen += points.size();
    for (const Lamp& lamp : lamps) {
      sunward.clear();
      askers.clear();
      for (std::size_t k = 0; k < points.size(); ++k) {
        accel::Ray ray;
        if (!shade::ray_from(points[k], met[k], lamp.towards, 2e-3, ray)) continue;
        sunward.push_back(ray);
        askers.push_back(k);
      }
      shaded.assign(sunward.size(), 0);
      tracer->occluded(sunward, shaded);
      for (std::size_t i = 0; i < sunward.size(); ++i) {
        if (shaded[i]) continue;
        const shade::SurfacePoint& point = points[askers[i]];
        const float facing = point.normal.dot(lamp.towards);
        const Rgb& share = facing > 0 ? point.reflectance : point.transmittance;
        sum += static_cast<double>(lamp.light * std::abs(facing) * luminance(share));
      }
    }
  }
  return seen > 0 ? sum / static_cast<double>(seen) : 0;
}

}  // namespace silvavis
