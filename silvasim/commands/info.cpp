// silvasim info: what an ecosystem file holds.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "silvasim/base/words.h"
#include "silvasim/commands/commands.h"
#include "silvasim/commands/console.h"
#include "silvasim/ecosystem/file.h"
#include "silvasim/fields/field_set.h"

namespace silvasim::commands {

namespace {

using Json = nlohmann::ordered_json;

Json as_json(const ecosystem::Summary& summary, const Path& path, const fields::FrameReport& frame) {
  const ecosystem::Ecosystem& e = summary.ecosystem;
  Json json;
  json["name"] = e.name;
  json["file"] = path.filename().string();
  json["bytes"] = summary.file_bytes;
  json["format"] = fmt::format("{}.{}", summary.format_major, summary.format_minor);
  json["extent"] = {
      {"west", e.extent.west}, {"south", e.extent.south}, {"east", e.extent.east}, {"north", e.extent.north}};
  json["crs_wkt"] = e.crs_wkt;
  if (frame.centre)
    json["centre"] = {{"latitude", frame.centre->latitude_deg}, {"longitude", frame.centre->longitude_deg}};
  json["terrain"] = {{"columns", e.terrain.columns}, {"rows", e.terrain.rows}};
  std::uint64_t sites = 0, plants = 0;
  json["layers"] = Json::array();
  for (std::size_t k = 0; k < e.layers.size(); ++k) {
    const ecosystem::Layer& layer = e.layers[k];
    const ecosystem::Summary::Plants& held = summary.plants[k];
    Json species = Json::array();
    for (std::size_t s = 0; s < held.by_species.size(); ++s) {
      species.push_back({{"name", layer.species[s].name},
                         {"common_name", layer.species[s].common_name},
                         {"colour", fmt::format("#{:06x}", layer.species[s].colour)},
                         {"model", layer.species[s].model},
                         {"plants", held.by_species[s]}});
    }
    sites += held.sites;
    plants += held.standing;
    json["layers"].push_back(
        {{"name", layer.name},
         {"sites", held.sites},
         {"plants", held.standing},
         {"tiles",
          {{"columns", layer.tiling.columns},
           {"rows", layer.tiling.rows},
           {"kinds", layer.tile_set.tiles.size()},
           {"side_m", layer.tile_set.side_m}}},
         {"most_radius_m", layer.tile_set.most_radius_m},
         {"probabilities", held.probabilities},
         {"suitability_cell_m", layer.suitability.empty() ? Json() : Json(layer.suitability.cell_m)},
         {"species", species}});
  }
  json["sites"] = sites;
  json["plants"] = plants;
  json["provenance"] = Json::parse(e.provenance_json, nullptr, false);
  return json;
}

void print(const ecosystem::Summary& summary, const Path& path, const fields::FrameReport& frame) {
  const ecosystem::Ecosystem& e = summary.ecosystem;
  fmt::print("{}  ({}, {})\n", base::printable(e.name), base::printable(path.string()), bytes_text(summary.file_bytes));
  fmt::print("extent   {:.2f} to {:.2f} east, {:.2f} to {:.2f} north; {:.2f} x {:.2f} km\n", e.extent.west,
             e.extent.east, e.extent.south, e.extent.north, e.extent.width() / 1000, e.extent.height() / 1000);
  if (frame.centre) {
    fmt::print("place    latitude {:.5f}, longitude {:.5f}, MGRS {}\n", frame.centre->latitude_deg,
               frame.centre->longitude_deg, frame.mgrs);
    fmt::print("frame    scale {:.6f} to {:.6f}, convergence {:.3f} degrees, earth drops {:.1f} m\n", frame.least_scale,
               frame.most_scale, frame.convergence_deg, frame.curvature_drop_m);
  } else {
    fmt::print("place    local metres, without a place on the earth\n");
  }
  if (e.terrain.columns > 0)
    fmt::print("terrain  {} x {} cells of {:.2f} m\n", e.terrain.columns, e.terrain.rows, e.terrain.cell_width_m);
  for (std::size_t k = 0; k < e.layers.size(); ++k) {
    const ecosystem::Layer& layer = e.layers[k];
    const ecosystem::Summary::Plants& held = summary.plants[k];
    fmt::print("layer    {}: {} plants on {} sites; {} x {} tiles of {:g} m, {} kinds{}\n", base::printable(layer.name),
               grouped(held.standing), grouped(held.sites), layer.tiling.columns, layer.tiling.rows,
               layer.tile_set.side_m, layer.tile_set.tiles.size(), held.probabilities ? ", with probabilities" : "");
    if (!layer.suitability.empty()) fmt::print("  suitability on cells of {:g} m\n", layer.suitability.cell_m);
    for (std::size_t s = 0; s < held.by_species.size(); ++s) {
      fmt::print("  {:<28} {:<28} {:>14} {:5.1f} %\n", base::printable(layer.species[s].name),
                 base::printable(layer.species[s].common_name), grouped(held.by_species[s]),
                 held.standing > 0
                     ? 100.0 * static_cast<double>(held.by_species[s]) / static_cast<double>(held.standing)
                     : 0.0);
    }
  }
  const Json provenance = Json::parse(e.provenance_json, nullptr, false);
  const auto said = [&](const char* key) {
    const auto found = provenance.find(key);
    if (found == provenance.end() || found->is_structured()) return std::string("?");
    return base::printable(found->is_string() ? found->get<std::string>() : found->dump());
  };
  if (provenance.is_object()) {
    fmt::print("made by  silvasim {}, seed {}, configuration {}\n", said("version"), said("seed"),
               base::printable(said("config_sha256").substr(0, 16)));
  }
}

}  // namespace

void info(const InfoOptions& options) {
  const ecosystem::Summary summary = ecosystem::read_summary(options.ecosystem);
  const fields::FrameReport frame = fields::report_frame({summary.ecosystem.crs_wkt, "", summary.ecosystem.extent});
  if (options.common.json) {
    fmt::print("{}\n", as_json(summary, options.ecosystem, frame).dump(2, ' ', false, Json::error_handler_t::replace));
  } else {
    print(summary, options.ecosystem, frame);
  }
}

}  // namespace silvasim::commands
