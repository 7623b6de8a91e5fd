#include "silvavis/shade/surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "silvavis/scene/instance.h"

namespace silvavis::shade {

namespace {

const std::array<float, 256>& linear_of_byte() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> values;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double encoded = static_cast<double>(i) / 255;  // IEC 61966-2-1
      values[i] = static_cast<float>(encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
    }
    return values;
  }();
  return table;
}

Rgb texture_colour(const assets::Texture& texture, const V2& uv) {
  const float u = uv.x - std::floor(uv.x), v = uv.y - std::floor(uv.y);
  const int x = std::min(static_cast<int>(u * static_cast<float>(texture.width)), texture.width - 1);
  const int y = std::min(static_cast<int>(v * static_cast<float>(texture.height)), texture.height - 1);
  const std::uint8_t* const pixel =
      texture.rgba.data() +
      (static_cast<std::size_t>(y) * static_cast<std::size_t>(texture.width) + static_cast<std::size_t>(x)) * 4;
  const auto& linear = linear_of_byte();
  return {linear[pixel[0]], linear[pixel[1]], linear[pixel[2]]};
}

V3 towards(const V3& normal, const V3& ray) { return normal.dot(ray) > 0 ? -normal : normal; }

SurfacePoint ground_point(const scene::Scene& scene, const Land& land, const accel::Ray& ray, SurfacePoint point) {
  const scene::GroundPoint ground = scene::ground_at(scene.ground, point.at.x, point.at.y);
  point.plane = towards(V3(static_cast<float>(-ground.slope_x), static_cast<float>(-ground.slope_y), 1).normalized(),
                        ray.direction);
  point.normal = scene::ground_normal(scene.ground, point.at.x, point.at.y);
  point.water = is_water(land, point.at.x, point.at.y);
  if (point.water) {
    point.normal = point.plane = V3(0, 0, 1);
    point.reflectance = Rgb(0.012f, 0.020f, 0.022f);  // what comes back from below the surface
  } else {
    point.reflectance = land_colour(land, point.at.x, point.at.y, point.normal);
  }
  return point;
}

}  // namespace

SurfacePoint surface_at(const scene::Scene& scene, const Land& land, const accel::Ray& ray, const accel::Hit& hit) {
  SurfacePoint point;
  point.at = ray.origin + V3d(ray.direction) * hit.distance;
  if (hit.surface == accel::Surface::ground) return ground_point(scene, land, ray, point);

  const scene::PlantModel& model = scene::model_at(scene, hit.model, hit.level);
  const scene::SlotNormals& normals = model.normals[hit.slot];
  const assets::Material& material = model.looks->materials[model.material_of(hit.slot)];
  const float w = 1 - hit.u - hit.v;
  const V3 local = scene::unpacked_normal(normals[0]) * w + scene::unpacked_normal(normals[1]) * hit.u +
                   scene::unpacked_normal(normals[2]) * hit.v;
  const V3 a = model.position_of(hit.slot, 0);
  const V3 plane = (model.position_of(hit.slot, 1) - a).cross(model.position_of(hit.slot, 2) - a);
  const scene::Instance plant =
      scene::instance_at(scene, scene.layers[hit.layer], hit.column, hit.row, hit.site_slot, hit.species);
  point.plane = towards(scene::turned(plant.turn, plane.normalized()), ray.direction);
  // A vertex normal belongs to the side on which the triangle runs anticlockwise.
  const V3 bent = scene::turned(plant.turn, local.length2() > 1e-6f ? local.normalized() : plane.normalized());
  const bool front = scene::turned(plant.turn, plane).dot(ray.direction) <= 0;
  point.normal = front ? bent : -bent;
  if (point.normal.dot(ray.direction) > 0) point.normal = point.plane;
  point.reflectance = material.reflectance * model.tint;
  point.transmittance = material.transmittance * model.tint;
  if (material.texture != assets::no_texture) {
    const V2 uv = model.uv_of(hit.slot, 0) * w + model.uv_of(hit.slot, 1) * hit.u + model.uv_of(hit.slot, 2) * hit.v;
    const Rgb colour = texture_colour(model.looks->textures[static_cast<std::size_t>(material.texture)], uv);
    point.reflectance *= colour;
    point.transmittance *= colour;
  }
  return point;
}

}  // namespace silvavis::shade
