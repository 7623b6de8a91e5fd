#include "silvavis/commands/info.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "silvasim/base/machine.h"
#include "silvasim/base/parallel.h"
#include "silvasim/base/words.h"

namespace silvavis::commands {

namespace {

using Json = nlohmann::ordered_json;
using silvasim::base::printable;
using silvasim::terminal::bytes_text;
using silvasim::terminal::grouped;

std::vector<std::uint64_t> counts_of(const scene::PlantLayer& layer) {
  std::vector<std::uint64_t> counts(layer.species.size());
  const std::uint64_t slots = layer.first_slot.back();
  for (std::uint64_t i = 0; i < slots; ++i) {
    const std::uint8_t species = layer.plant_species[i];
    if (species < counts.size()) ++counts[species];
  }
  return counts;
}

std::uint64_t detail_bytes(const scene::Scene& scene) {
  std::uint64_t sum = 0;
  for (const scene::DetailLayer& layer : scene.details) sum += layer.instances_bytes();
  return sum;
}

struct Counted {
  std::vector<std::vector<std::uint64_t>> plants;  // by layer, by species
  std::size_t model_bytes = 0;
};

Json as_json(const Stage& stage, const Path& file, const Counted& counted) {
  const scene::Scene& scene = stage.scene;
  const silvasim::base::Point& o = scene.origin;
  Json json;
  json["file"] = file.filename().string();
  json["plants"] = scene.plants;
  json["models"] = scene.models.size();
  json["extent"] = {{"west", scene.extent.west + o.x},
                    {"south", scene.extent.south + o.y},
                    {"east", scene.extent.east + o.x},
                    {"north", scene.extent.north + o.y}};
  json["land"] = {{"columns", scene.ground.columns - 1},
                  {"rows", scene.ground.rows - 1},
                  {"cell_x_m", scene.ground.cell_x_m},
                  {"cell_y_m", scene.ground.cell_y_m},
                  {"least_m", scene.ground.pyramid.origin_m},
                  {"greatest_m", scene.ground.pyramid.origin_m + 65535 * scene.ground.pyramid.step_m}};
  json["layers"] = Json::array();
  for (std::size_t k = 0; k < scene.layers.size(); ++k) {
    const scene::PlantLayer& layer = scene.layers[k];
    Json species = Json::array();
    for (std::size_t s = 0; s < layer.species.size(); ++s) {
      const scene::SpeciesModels& own = layer.species[s];
      Json models = Json::array();
      for (std::uint32_t v = 0; v < own.variants; ++v) {
        const scene::PlantModel& model = *scene.models[own.first_model + v];
        models.push_back({{"name", model.name}, {"triangles", model.triangles}, {"bytes", model.bytes()}});
      }
      species.push_back({{"number", layer.first_species + s},
                         {"name", own.name},
                         {"plants", counted.plants[k][s]},
                         {"source", stage.model_sources[k][s]},
                         {"models", models}});
    }
    json["layers"].push_back(
        {{"name", layer.name},
         {"first_plant", layer.first_plant},
         {"sites", layer.first_slot.back()},
         {"tiles", {{"columns", layer.columns}, {"rows", layer.rows}, {"side_m", layer.tile_side_m}}},
         {"species", species}});
  }
  json["details"] = Json::array();
  for (const scene::DetailLayer& layer : scene.details)
    json["details"].push_back({{"name", layer.name},
                               {"instances", layer.count()},
                               {"candidates", layer.frames.size()},
                               {"objects", layer.objects},
                               {"first_object", layer.first_object},
                               {"first_plant", layer.first_plant},
                               {"tile_side_m", layer.side_m},
                               {"bytes", layer.instances_bytes()}});
  json["bytes"] = {{"plants", scene.plant_bytes()},
                   {"details", detail_bytes(scene)},
                   {"models", counted.model_bytes},
                   {"tracer", stage.tracer->bytes()},
                   {"peak_rss", silvasim::base::peak_rss_bytes()}};
  const Stage::Seconds& t = stage.seconds;
  json["seconds"] = {{"read", t.read},       {"models", t.models}, {"scene", t.scene},
                     {"details", t.details}, {"tracer", t.tracer}, {"light", t.light}};
  json["warnings"] = stage.warnings;
  return json;
}

void print(const Stage& stage, const Path& file, const Counted& counted) {
  const scene::Scene& scene = stage.scene;
  const silvasim::base::Point& o = scene.origin;
  const scene::Pyramid& heights = scene.ground.pyramid;
  fmt::print("{}: {} plants, {} models\n", printable(file.string()), grouped(scene.plants), scene.models.size());
  fmt::print("extent   {:.2f} to {:.2f} east, {:.2f} to {:.2f} north; {:.2f} x {:.2f} km\n", scene.extent.west + o.x,
             scene.extent.east + o.x, scene.extent.south + o.y, scene.extent.north + o.y, scene.extent.width() / 1000,
             scene.extent.height() / 1000);
  fmt::print("land     {} x {} cells of {:g} x {:g} m, {:.1f} to {:.1f} m high\n", scene.ground.columns - 1,
             scene.ground.rows - 1, scene.ground.cell_x_m, scene.ground.cell_y_m, heights.origin_m,
             heights.origin_m + 65535 * heights.step_m);
  for (std::size_t k = 0; k < scene.layers.size(); ++k) {
    const scene::PlantLayer& layer = scene.layers[k];
    fmt::print("layer    {}: {} x {} tiles of {:g} m\n", printable(layer.name), layer.columns, layer.rows,
               layer.tile_side_m);
    for (std::size_t s = 0; s < layer.species.size(); ++s) {
      const scene::SpeciesModels& own = layer.species[s];
      std::string model = "not drawn";
      if (own.variants > 0) {
        std::uint64_t triangles = 0;
        for (std::uint32_t v = 0; v < own.variants; ++v) triangles += scene.models[own.first_model + v]->triangles;
        const std::string& source = stage.model_sources[k][s];
        model = fmt::format(
            "{}, {} triangles{}", source == "grown" ? "grown as " + scene.models[own.first_model]->name : source,
            grouped(triangles / own.variants), own.variants > 1 ? fmt::format(", {} variants", own.variants) : "");
      }
      fmt::print("  {:<28} {:>14}  {}\n", printable(own.name), grouped(counted.plants[k][s]), printable(model));
    }
  }
  for (const scene::DetailLayer& layer : scene.details) {
    fmt::print("details  {}: {} of {} candidates in tiles of {:g} m, {}\n", printable(layer.name),
               grouped(layer.count()), grouped(layer.frames.size()), layer.side_m, bytes_text(layer.instances_bytes()));
    for (std::size_t k = 0; k < layer.objects.size(); ++k) {
      std::uint64_t count = 0;
      for (std::uint64_t i = 0; i < layer.count(); ++i) count += layer.frames[layer.chosen[i]].object == k ? 1 : 0;
      fmt::print("  {:<28} {:>14}\n", printable("detail: " + layer.objects[k]), grouped(count));
    }
  }
  const Stage::Seconds& t = stage.seconds;
  fmt::print("memory   plants {}, {}models {}, peak {}\n", bytes_text(scene.plant_bytes()),
             scene.details.empty() ? "" : "details " + bytes_text(detail_bytes(scene)) + ", ",
             bytes_text(counted.model_bytes), bytes_text(silvasim::base::peak_rss_bytes()));
  fmt::print("seconds  read {:.2f}, models {:.2f}, scene {:.2f}, details {:.2f}, tracer {:.2f}, light {:.2f}\n", t.read,
             t.models, t.scene, t.details, t.tracer, t.light);
}

}  // namespace

void info(const InfoOptions& options) {
  const Common& common = options.stage.common;
  const silvasim::base::ThreadLimit threads(common.threads);
  const std::unique_ptr<Stage> stage = set_stage(options.stage, silvasim::terminal::console_progress(common));
  silvasim::terminal::end_progress(common);
  Counted counted;
  for (const scene::PlantLayer& layer : stage->scene.layers) counted.plants.push_back(counts_of(layer));
  for (const auto& model : stage->scene.models) counted.model_bytes += model->bytes();
  if (common.json) {
    fmt::print("{}\n",
               as_json(*stage, options.stage.ecosystem, counted).dump(2, ' ', false, Json::error_handler_t::replace));
  } else {
    print(*stage, options.stage.ecosystem, counted);
  }
}

}  // namespace silvavis::commands
