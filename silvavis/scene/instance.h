// Where a plant stands, how large it is and how it is turned: the one rule that every backend decodes plants by.
//
// Turn and variant are pseudo-random by tile position and site id (Silva 2013, section 5), so that the same plant looks the
// same in every picture.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "silvavis/base/vector.h"
#include "silvavis/scene/scene.h"

namespace silvavis::scene {

struct Turn {
  float cosine, sine;
};
// 256 turns are enough to hide that models repeat.
const std::array<Turn, 256>& turns();

struct Instance {
  V3d foot{0, 0, 0};  // world space
  float scale = 1;
  Turn turn{1, 0};
  std::uint32_t model = 0;  // into Scene::models
  float dither = 0;         // in [0, 1): its own, so that neighbours change their level at different distances
  std::uint32_t side = 0;   // from which it is seen as an impostor
};

// A mixing of bits with the avalanche of murmur3's finaliser: every bit of place and site changes every bit of it.
inline std::uint32_t place_hash(std::uint64_t seed, std::uint32_t column, std::uint32_t row, std::uint32_t site) {
  std::uint64_t h = seed * 0x9E3779B97F4A7C15u + (static_cast<std::uint64_t>(column) << 32 | row);
  h = (h ^ (h >> 33)) * 0xFF51AFD7ED558CCDu + site;
  h = (h ^ (h >> 33)) * 0xC4CEB9FE1A85EC53u;
  return static_cast<std::uint32_t>(h >> 32);
}

inline Instance instance_at(const Scene& scene, const PlantLayer& layer, int column, int row, std::uint32_t slot,
                            std::uint8_t species_id) {
  const std::size_t position = layer.position(column, row);
  const TileSites& tile = layer.tile_sites[layer.tiles[position]];
  const SpeciesModels& species = layer.species[species_id];
  const std::uint32_t hash = place_hash(scene.seed + layer.first_species, static_cast<std::uint32_t>(column),
                                        static_cast<std::uint32_t>(layer.rows - 1 - row), tile.site_ids[slot]);
  Instance instance;
  const std::uint16_t height = layer.plant_heights[layer.first_slot[position] + slot];
  instance.foot = {layer.west + column * layer.tile_side_m + static_cast<double>(tile.x_m[slot]),
                   layer.south + row * layer.tile_side_m + static_cast<double>(tile.y_m[slot]),
                   static_cast<double>(layer.base_m[position]) +
                       static_cast<double>(layer.step_m[position]) * static_cast<double>(height)};
  instance.scale = tile.radius_m[slot] / species.model_radius_m;
  instance.turn = turns()[hash & 255];
  instance.dither = static_cast<float>(hash >> 3 & 255) / 256.0f;
  instance.side = (hash >> 11 & 255) * Impostor::sides >> 8;
  instance.model = species.first_model +
                   static_cast<std::uint32_t>((static_cast<std::uint64_t>(hash >> 8) * species.variants) >> 24);
  return instance;
}

// An impostor's texels may be a little wider than a pixel: they are blurred into each other.
inline constexpr float texels_a_pixel = 0.6f;

// Which level of a model to meet with a ray of this width: the simplest whose leaves, or texels, are no wider.
inline std::uint8_t level_for(const PlantModel& model, const Instance& instance, float width_m) {
  const float wide = width_m / (instance.scale * (0.75f + 0.5f * instance.dither));
  if (model.impostor && texels_a_pixel * model.impostor->texel_m <= wide)
    return static_cast<std::uint8_t>(model.coarser.size() + 1);
  std::uint8_t level = 0;
  while (level < model.coarser.size() && model.coarser[level]->leaf_m <= wide) ++level;
  return level;
}
inline bool is_impostor(const PlantModel& model, std::uint8_t level) { return level > model.coarser.size(); }

// A ray in a model's space: from the point of the ray nearest to the plant's axis on, so that floats keep a fraction of
// a millimetre however far the eye is. Distances along it are (t - start) / scale.
struct LocalRay {
  V3 origin{0, 0, 0};
  V3 direction{0, 0, 1};
  double start = 0;  // distance along the world's ray of the local origin, the point nearest to the foot
};

inline LocalRay local_ray(const Instance& instance, const V3d& origin, const V3& direction) {
  const double dx = static_cast<double>(direction.x), dy = static_cast<double>(direction.y),
               dz = static_cast<double>(direction.z);
  const double x = origin.x - instance.foot.x, y = origin.y - instance.foot.y, z = origin.z - instance.foot.z;
  const double t = -(x * dx + y * dy + z * dz);
  const double size = 1.0 / static_cast<double>(instance.scale);
  const V3 moved(static_cast<float>((x + t * dx) * size), static_cast<float>((y + t * dy) * size),
                 static_cast<float>((z + t * dz) * size));
  const auto [c, s] = instance.turn;
  LocalRay ray;
  ray.origin = {c * moved.x + s * moved.y, c * moved.y - s * moved.x, moved.z};
  ray.direction = {c * direction.x + s * direction.y, c * direction.y - s * direction.x, direction.z};
  ray.start = t;
  return ray;
}

// A direction of the model's space in the world's.
inline V3 turned(const Turn& turn, const V3& v) {
  return {turn.cosine * v.x - turn.sine * v.y, turn.sine * v.x + turn.cosine * v.y, v.z};
}

}  // namespace silvavis::scene
