#include "silvavis/shade/surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "silvavis/scene/instance.h"
#include "silvavis/shade/own_shadow.h"

namespace silvavis::shade {

namespace {

using scene::Impostor;

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

// An impostor's grid turns with who looks.
scene::Turn turn_to(std::uint32_t side, const V3& direction) {
  const V3 from = scene::impostor_direction(Impostor::elevations / 2, static_cast<int>(side));
  const scene::ImpostorView is({}, direction), was({}, from);
  return {is.ahead_x * was.ahead_x + is.ahead_y * was.ahead_y, was.ahead_x * is.ahead_y - was.ahead_y * is.ahead_x};
}

SurfacePoint ground_point(const scene::Scene& scene, const Land& land, const accel::Ray& ray, double distance_m,
                          SurfacePoint point) {
  const scene::GroundPoint ground = scene::ground_at(scene.ground, point.at.x, point.at.y);
  point.plane = towards(V3(static_cast<float>(-ground.slope_x), static_cast<float>(-ground.slope_y), 1).normalized(),
                        ray.direction);
  point.normal = scene::ground_normal(scene.ground, point.at.x, point.at.y);
  point.water = is_water(land, point.at.x, point.at.y);
  if (point.water) {
    point.normal = point.plane = V3(0, 0, 1);
    point.reflectance = Rgb(0.012f, 0.020f, 0.022f);  // what comes back from below the surface
  } else {
    // A slanting ray covers an ellipse; it stands for a circle of the same size.
    const float facing = std::max(0.05f, -point.plane.dot(ray.direction));
    const double width_m = (static_cast<double>(ray.width_m) + static_cast<double>(ray.spread) * distance_m) /
                           std::sqrt(static_cast<double>(facing));
    point.reflectance = land_colour(land, point.at.x, point.at.y, point.normal, point.at.z,
                                    crowns_over(scene, point.at.x, point.at.y), width_m);
    for (const scene::DetailLayer& layer : scene.details) {
      const scene::DetailCover cover =
          scene::detail_cover(layer, point.at, ray.width_m + ray.spread * static_cast<float>(distance_m));
      point.reflectance = point.reflectance * (cover.gap_light * (1 - cover.share)) + cover.colour * cover.share;
    }
  }
  return point;
}

}  // namespace

SurfacePoint surface_at(const scene::Scene& scene, const Land& land, const accel::Ray& ray, const accel::Hit& hit) {
  SurfacePoint point;
  point.at = ray.origin + V3d(ray.direction) * hit.distance;
  if (hit.surface == accel::Surface::ground) return ground_point(scene, land, ray, hit.distance, point);

  const scene::PlantModel& full = *scene.models[hit.model];
  std::uint32_t slot = hit.slot;
  float u = hit.u, v = hit.v, tint = 1;
  if (scene::is_impostor(full, hit.level)) {
    const Impostor::Point& met = full.impostor->points[hit.slot];
    point.told = &full;
    slot = met.slot;
    u = met.weight_1();
    v = met.weight_2();
  }
  const scene::PlantModel& model = hit.level == 0 || point.told ? full : *full.coarser[hit.level - 1u];
  if (!point.told) tint = model.tint;
  const scene::SlotNormals& normals = model.normals[slot];
  const assets::Material& material = model.looks->materials[model.material_of(slot)];
  const float w = 1 - u - v;
  const V3 local = scene::unpacked_normal(normals[0]) * w + scene::unpacked_normal(normals[1]) * u +
                   scene::unpacked_normal(normals[2]) * v;
  const V3 a = model.position_of(slot, 0);
  const V3 plane = (model.position_of(slot, 1) - a).cross(model.position_of(slot, 2) - a);
  const auto look = [&](const auto& turned) {
    point.plane = towards(turned(plane.normalized()), ray.direction);
    // A vertex normal belongs to the side on which the triangle runs anticlockwise.
    const V3 bent = turned(local.length2() > 1e-6f ? local.normalized() : plane.normalized());
    const bool front = turned(plane).dot(ray.direction) <= 0;
    point.normal = front ? bent : -bent;
    if (point.normal.dot(ray.direction) > 0) point.normal = point.plane;
  };
  if (hit.surface == accel::Surface::detail) {
    const scene::DetailLayer& layer = scene.details[hit.layer];
    const scene::DetailFrame& frame = layer.frames[layer.chosen[hit.site_slot]];
    look([&](const V3& of_model) { return frame.turned(of_model); });
  } else {
    const scene::Instance plant =
        scene::instance_at(scene, scene.layers[hit.layer], hit.column, hit.row, hit.site_slot, hit.species);
    point.turn = point.told ? turn_to(plant.side, ray.direction) : plant.turn;
    look([&](const V3& of_model) { return scene::turned(point.turn, of_model); });
  }
  point.reflectance = material.reflectance * tint;
  point.transmittance = material.transmittance * tint;
  if (material.texture != assets::no_texture) {
    const V2 uv = model.uv_of(slot, 0) * w + model.uv_of(slot, 1) * u + model.uv_of(slot, 2) * v;
    const Rgb colour = texture_colour(model.looks->textures[static_cast<std::size_t>(material.texture)], uv);
    point.reflectance *= colour;
    point.transmittance *= colour;
  }
  return point;
}

bool ray_from(const SurfacePoint& point, const accel::Hit& hit, const V3& towards, double lift_m, accel::Ray& ray) {
  ray.origin = point.at + V3d(point.plane) * (point.plane.dot(towards) > 0 ? lift_m : -lift_m);
  ray.direction = towards;
  if (!point.told) return true;
  const auto [c, s] = point.turn;
  const V3 local(c * towards.x + s * towards.y, c * towards.y - s * towards.x, towards.z);
  if (local.z > 0 && is_barred(*point.told, hit.slot, local, scene::ray_hash(ray.origin, towards))) return false;
  ray.left_slot = hit.site_slot;
  ray.left_column = hit.column;
  ray.left_row = hit.row;
  ray.left_layer = hit.layer;
  return true;
}

}  // namespace silvavis::shade
