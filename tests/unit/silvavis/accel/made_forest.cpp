#include "made_forest.h"

#include <cmath>
#include <numbers>

#include "silvasim/base/random.h"
#include "silvasim/tiles/fill.h"
#include "silvasim/tiles/tile_land.h"
#include "silvavis/accel/pack.h"

namespace silvavis::testing {

namespace {

namespace ecosystem = silvasim::ecosystem;
using silvasim::base::Purpose;
using silvasim::base::Stream;

V3 random_direction(Stream& random) {
  const float z = random.next_float() * 2 - 1, angle = random.next_float() * 2 * std::numbers::pi_v<float>;
  const float r = std::sqrt(std::max(0.0f, 1 - z * z));
  return {r * std::cos(angle), r * std::sin(angle), z};
}

void add_quad(assets::Model& model, const V3& at, const V3& u, const V3& v, std::uint16_t material) {
  const auto first = static_cast<std::uint32_t>(model.positions.size());
  const V3 normal = u.cross(v).normalized();
  const V2 uvs[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const V3 corners[4] = {at - u - v, at + u - v, at + u + v, at - u + v};
  for (int i = 0; i < 4; ++i) {
    model.positions.push_back(corners[i]);
    model.normals.push_back(normal);
    model.uvs.push_back(uvs[i]);
  }
  model.triangles.push_back({first, first + 1, first + 2});
  model.triangles.push_back({first, first + 2, first + 3});
  model.triangle_materials.insert(model.triangle_materials.end(), 2, material);
}

ecosystem::Layer layer_of(const MadeForest& made, std::uint32_t number, double side_m, double least_m, double most_m) {
  ecosystem::Layer layer;
  layer.name = number == 0 ? "trees" : "shrubs";
  silvasim::config::TileSettings settings;
  settings.side_m = side_m;
  settings.least_radius_m = least_m;
  settings.most_radius_m = most_m;
  settings.coverage = made.coverage;
  layer.tile_set = silvasim::tiles::fill_tiles(settings, made.seed, number);
  const int columns = static_cast<int>(std::ceil(made.columns * made.side_m / side_m));
  const int rows = static_cast<int>(std::ceil(made.rows * made.side_m / side_m));
  layer.tiling = silvasim::tiles::tile_land(layer.tile_set, columns, rows, made.seed, number);
  layer.north_west = {made.west, made.south + made.rows * made.side_m};
  for (const char* name : {"Ball", "Slim", "Absent"}) {
    ecosystem::Species species;
    species.name = name;
    species.model_radius_m = static_cast<float>(0.7 * most_m);
    species.height_m = static_cast<float>(3 * most_m);
    layer.species.push_back(species);
  }
  const auto offsets = ecosystem::site_offsets(layer.tile_set, layer.tiling);
  layer.plants.resize(offsets.back());
  Stream random(made.seed, Purpose::selection, number);
  for (auto& plant : layer.plants) {
    const std::uint32_t draw = random.next_below(10);
    plant = draw < 5 ? 0 : draw < 8 ? 1 : draw < 9 ? 2 : ecosystem::no_plant;
  }
  return layer;
}

}  // namespace

assets::Model leaf_ball(int leaves, double height_m, double radius_m, bool holes, std::uint64_t seed) {
  assets::Model model;
  model.name = "leaf ball";
  Stream random(seed, Purpose::rotation, static_cast<std::uint32_t>(leaves));
  const auto height = static_cast<float>(height_m), radius = static_cast<float>(radius_m);
  model.materials.resize(2);
  for (int side = 0; side < 4; ++side) {
    const float angle = static_cast<float>(side) * std::numbers::pi_v<float> / 2;
    const V3 out(std::cos(angle), std::sin(angle), 0), along(-out.y, out.x, 0);
    add_quad(model, out * (0.06f * radius) + V3(0, 0, 0.25f * height), along * (0.06f * radius),
             V3(0, 0, 0.27f * height), 0);
  }
  for (int i = 0; i < leaves; ++i) {
    const V3 p = random_direction(random) * std::cbrt(random.next_float()) * 0.9f;
    const V3 u = random_direction(random), w = random_direction(random);
    const V3 v = u.cross(w).normalized();
    const float size = 0.35f * radius / std::cbrt(static_cast<float>(leaves) / 10.0f);
    add_quad(model, {p.x * radius, p.y * radius, height * (0.62f + 0.36f * p.z)}, u * size, v * size, 1);
  }
  if (holes) {
    assets::Texture texture;
    texture.name = "thirds";
    texture.width = texture.height = 32;
    texture.has_alpha = true;
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x)
        texture.rgba.insert(texture.rgba.end(),
                            {60, 140, 40, static_cast<std::uint8_t>((x / 4 + y / 4) % 3 == 0 ? 0 : 255)});
    model.textures.push_back(texture);
    model.materials[1].texture = 0;
    model.materials[1].alpha_cutoff = 0.5f;
  }
  return model;
}

ecosystem::Ecosystem made_ecosystem(const MadeForest& made) {
  ecosystem::Ecosystem e;
  e.name = "made";
  e.extent = {made.west, made.south, made.west + made.columns * made.side_m, made.south + made.rows * made.side_m};
  e.layers.push_back(layer_of(made, 0, made.side_m, 2, 6));
  if (made.shrubs) e.layers.push_back(layer_of(made, 1, made.side_m * 0.55, 0.5, 1.5));
  if (made.hills_m > 0) {
    e.terrain.cell_width_m = made.cell_m;
    e.terrain.cell_height_m = made.cell_m * 0.9;
    e.terrain.columns = static_cast<int>(std::ceil(e.extent.width() / e.terrain.cell_width_m)) + 1;
    e.terrain.rows = static_cast<int>(std::ceil(e.extent.height() / e.terrain.cell_height_m)) + 1;
    e.terrain.west = made.west;
    e.terrain.north = made.south + e.extent.height();
    for (int row = 0; row < e.terrain.rows; ++row) {
      for (int column = 0; column < e.terrain.columns; ++column) {
        const double x = column * e.terrain.cell_width_m, y = row * e.terrain.cell_height_m;
        e.terrain.heights_m.push_back(static_cast<float>(
            300 + made.hills_m * (std::sin(x / 53) * std::cos(y / 41) + 0.3 * std::sin(x / 17 + y / 13))));
      }
    }
  }
  return e;
}

scene::Scene made_forest(const MadeForest& made) {
  ecosystem::Ecosystem e = made_ecosystem(made);
  std::vector<std::vector<scene::SpeciesModelSet>> models;
  for (const ecosystem::Layer& layer : e.layers) {
    const double radius = static_cast<double>(layer.species[0].model_radius_m),
                 height = static_cast<double>(layer.species[0].height_m);
    const auto packed = [&](int leaves, double narrow, bool holes, std::uint64_t seed) {
      return std::make_shared<const scene::PlantModel>(
          accel::pack(leaf_ball(leaves, height, radius * narrow, holes, seed)));
    };
    models.push_back({{packed(400, 1, true, made.seed), packed(300, 1, true, made.seed + 1)},
                      {packed(200, 0.5, false, made.seed + 2)},
                      {}});
  }
  return scene::make_scene(std::move(e), models);
}

}  // namespace silvavis::testing
