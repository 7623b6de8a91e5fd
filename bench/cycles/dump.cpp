#include "cycles/dump.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "cycles/npy.h"
#include "silvasim/base/error.h"
#include "silvasim/base/file.h"
#include "silvavis/scene/instance.h"
#include "silvavis/shade/land.h"
#include "views.h"

namespace silva_bench {

namespace {

namespace fs = std::filesystem;
using namespace silvavis;
using Json = nlohmann::ordered_json;

Json numbers(const V3& v) { return {v.x, v.y, v.z}; }
Json numbers(const V3d& v) { return {v.x, v.y, v.z}; }
Json numbers(const Rgb& c) { return {c.x, c.y, c.z}; }

void write_png(const fs::path& path, const assets::Texture& texture) {
  auto output = OIIO::ImageOutput::create("png");
  OIIO::ImageSpec spec(texture.width, texture.height, 4, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:UnassociatedAlpha", 1);  // colours are not multiplied with alpha, and must not be divided by it
  spec.attribute("oiio:ColorSpace", "sRGB");
  silvasim::base::NewFile file(path);
  if (!output || !output->open(file.path().string(), spec) ||
      !output->write_image(OIIO::TypeDesc::UINT8, texture.rgba.data()) || !output->close())
    throw silvasim::base::Error(path.string() + ": cannot write the texture");
  file.commit();
}

Json dump_looks(const scene::Looks& looks, const std::string& name, const fs::path& folder) {
  std::vector<std::string> textures;
  for (const assets::Texture& texture : looks.textures) {
    textures.push_back(fmt::format("{}.texture-{}.png", name, textures.size()));
    write_png(folder / textures.back(), texture);
  }
  Json materials = Json::array();
  for (const assets::Material& material : looks.materials) {
    Json entry{{"name", material.name},
               {"reflectance", numbers(material.reflectance)},
               {"transmittance", numbers(material.transmittance)},
               {"alpha_cutoff", material.alpha_cutoff},
               {"two_sided", material.two_sided}};
    if (material.texture != assets::no_texture) entry["texture"] = textures[static_cast<std::size_t>(material.texture)];
    materials.push_back(entry);
  }
  return materials;
}

Json dump_model(const scene::PlantModel& model, std::size_t number, const fs::path& folder) {
  const std::string name = fmt::format("model-{:03}", number);
  std::vector<float> positions, normals, uvs;
  std::vector<std::uint16_t> materials;
  for (std::uint32_t slot = 0; slot < model.blocks.size() * scene::block_size; ++slot) {
    const V3 a = model.position_of(slot, 0), b = model.position_of(slot, 1), c = model.position_of(slot, 2);
    if (a == b && a == c) continue;  // an empty lane
    for (int corner = 0; corner < 3; ++corner) {
      const V3 at = model.position_of(slot, corner),
               normal = scene::unpacked_normal(model.normals[slot][static_cast<std::size_t>(corner)]);
      const V2 uv = model.uv_of(slot, corner);
      positions.insert(positions.end(), {at.x, at.y, at.z});
      normals.insert(normals.end(), {normal.x, normal.y, normal.z});
      uvs.insert(uvs.end(), {uv.x, uv.y});
    }
    materials.push_back(model.material_of(slot));
  }
  write_npy(folder / (name + ".positions.npy"), positions, 3);
  write_npy(folder / (name + ".normals.npy"), normals, 3);
  write_npy(folder / (name + ".uvs.npy"), uvs, 2);
  write_npy(folder / (name + ".materials.npy"), materials);
  return {{"file", name},
          {"name", model.name},
          {"triangles", materials.size()},
          {"materials", dump_looks(*model.looks, name, folder)}};
}

Json dump_ground(const scene::Scene& scene, const shade::Land& land, const fs::path& folder) {
  const scene::Ground& ground = scene.ground;
  std::vector<float> colours;
  for (int row = 0; row < ground.rows; ++row) {
    for (int column = 0; column < ground.columns; ++column) {
      const double x = ground.west + column * ground.cell_x_m, y = ground.south + row * ground.cell_y_m;
      const Rgb colour =
          shade::land_colour(land, x, y, scene::ground_normal(ground, x, y),
                             static_cast<double>(ground.at(column, row)), shade::crowns_over(scene, x, y));
      colours.insert(colours.end(), {colour.x, colour.y, colour.z});
    }
  }
  write_npy(folder / "ground.heights.npy", ground.heights_m, static_cast<std::size_t>(ground.columns));
  write_npy(folder / "ground.colours.npy", colours, 3);
  return {{"columns", ground.columns}, {"rows", ground.rows},         {"west", ground.west},
          {"south", ground.south},     {"cell_x_m", ground.cell_x_m}, {"cell_y_m", ground.cell_y_m}};
}

// One row a plant, layer by layer, tile position by tile position from the south-west.
std::size_t dump_instances(const scene::Scene& scene, const fs::path& folder) {
  std::vector<float> positions, scales, turns;
  std::vector<std::uint16_t> models;
  for (const scene::PlantLayer& layer : scene.layers) {
    for (int row = 0; row < layer.rows; ++row) {
      for (int column = 0; column < layer.columns; ++column) {
        const std::size_t position = layer.position(column, row);
        const scene::TileSites& tile = layer.tile_sites[layer.tiles[position]];
        for (std::uint32_t slot = 0; slot < tile.count; ++slot) {
          const std::uint8_t species = layer.plant_species[layer.first_slot[position] + slot];
          if (species == scene::no_species) continue;
          const scene::Instance plant = scene::instance_at(scene, layer, column, row, slot, species);
          positions.insert(positions.end(), {static_cast<float>(plant.foot.x), static_cast<float>(plant.foot.y),
                                             static_cast<float>(plant.foot.z)});
          scales.push_back(plant.scale);
          turns.push_back(std::atan2(plant.turn.sine, plant.turn.cosine));
          models.push_back(static_cast<std::uint16_t>(plant.model));
        }
      }
    }
  }
  if (models.size() != scene.plants)
    throw silvasim::base::Error(fmt::format("the table has {} plants, but the scene {}", models.size(), scene.plants));
  write_npy(folder / "instances.positions.npy", positions, 3);
  write_npy(folder / "instances.scales.npy", scales);
  write_npy(folder / "instances.turns.npy", turns);
  write_npy(folder / "instances.models.npy", models);
  return models.size();
}

}  // namespace

void dump(const scene::Scene& scene, const Light& light, const shade::Land& land, const fs::path& folder) {
  fs::create_directories(folder);
  Json json;
  json["origin"] = {scene.origin.x, scene.origin.y};
  json["crs_wkt"] = scene.crs_wkt;
  json["sun"] = {{"direction", numbers(light.sky.sun_direction())},
                 {"irradiance", numbers(light.over_land.sun_irradiance())},
                 {"from_above", numbers(light.over_land.irradiance(V3(0, 0, 1)))},
                 {"from_below", numbers(light.over_land.irradiance(V3(0, 0, -1)))},
                 {"horizon", numbers(light.sky.radiance(V3(0, 1, 0.1f).normalized()))}};
  for (std::size_t view = 0; view < views.size(); ++view) {
    const shade::Camera camera = camera_of(scene, view);
    json["cameras"].push_back({{"name", views[view]},
                               {"eye", numbers(camera.eye)},
                               {"look_at", numbers(camera.look_at)},
                               {"horizontal_fov_deg", camera.fov_deg}});
  }
  json["ground"] = dump_ground(scene, land, folder);
  json["models"] = Json::array();
  for (std::size_t i = 0; i < scene.models.size(); ++i)
    json["models"].push_back(dump_model(*scene.models[i], i, folder));
  json["instances"] = dump_instances(scene, folder);
  silvasim::base::NewFile file(folder / "scene.json");
  file.write(json.dump(1) + "\n");
  file.commit();
}

}  // namespace silva_bench
