// silvasim run: the main job.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "silvasim/base/error.h"
#include "silvasim/base/machine.h"
#include "silvasim/base/parallel.h"
#include "silvasim/commands/commands.h"
#include "silvasim/commands/console.h"
#include "silvasim/commands/outputs.h"
#include "silvasim/ecosystem/file.h"
#include "silvasim/export/formats.h"
#include "silvasim/export/picture.h"
#include "silvasim/pipeline.h"
#include "silvasim/provenance.h"

namespace silvasim::commands {

namespace {

using Json = nlohmann::ordered_json;

std::vector<Path> inputs_of(const config::Scenario& scenario) {
  std::vector<Path> inputs;
  for (const config::SourceFile& file : scenario.files) inputs.emplace_back(file.path);
  for (const config::FieldSettings& field : scenario.fields) {
    if (!field.path.empty()) inputs.push_back(field.path);
  }
  return inputs;
}

// Many scenarios are called ecosystem.xml, each in a folder of its own: those are told apart by the folder.
Path default_output(const Path& ecosystem) {
  std::string name = ecosystem.stem().string();
  const std::string folder = std::filesystem::absolute(ecosystem).parent_path().filename().string();
  if (name == "ecosystem" && !folder.empty()) name = folder;
  return name + ".silva";
}

Json layer_json(const LayerReport& layer, const ecosystem::Layer& grown) {
  Json by_species = Json::object();
  for (std::size_t s = 0; s < grown.species.size(); ++s) by_species[grown.species[s].name] = layer.plants_by_species[s];
  Json no_data = Json::object();
  for (const auto& [field, share] : layer.no_data) no_data[field] = share;
  return {{"name", layer.name},
          {"sites", layer.sites},
          {"plants", layer.plants},
          {"plants_by_species", by_species},
          {"tiles",
           {{"columns", layer.tile_columns},
            {"rows", layer.tile_rows},
            {"kinds", layer.tile_kinds},
            {"side_m", grown.tile_set.side_m}}},
          {"no_data", no_data},
          {"neighbourhood_passes", layer.neighbourhoods.passes},
          {"neighbourhood_changed", layer.neighbourhoods.changed},
          {"neighbourhood_cell_m", layer.neighbourhoods.cell_m},
          {"corner_conflicts", layer.corners.conflicts},
          {"corner_components", layer.corners.components},
          {"corner_largest", layer.corners.largest},
          {"corner_fallbacks", layer.corners.fallbacks},
          {"corner_removed", layer.corners.removed}};
}

Json report_json(const config::Scenario& scenario, const Simulation& simulation, int threads, double total) {
  Json json;
  std::uint64_t sites = 0, plants = 0, tiles = 0, conflicts = 0, removed = 0;
  int passes = 0;
  Json by_species = Json::object(), layers = Json::array();
  for (std::size_t i = 0; i < simulation.report.layers.size(); ++i) {
    const LayerReport& layer = simulation.report.layers[i];
    sites += layer.sites;
    plants += layer.plants;
    tiles += static_cast<std::uint64_t>(layer.tile_columns) * static_cast<std::uint64_t>(layer.tile_rows);
    conflicts += layer.corners.conflicts;
    removed += layer.corners.removed;
    passes = std::max(passes, layer.neighbourhoods.passes);
    Json one = layer_json(layer, simulation.ecosystem.layers[i]);
    // A species may grow in several layers.
    for (const auto& [name, count] : one["plants_by_species"].items()) {
      by_species[name] = by_species.value(name, std::uint64_t{0}) + count.get<std::uint64_t>();
    }
    layers.push_back(std::move(one));
  }
  json["name"] = scenario.name;
  json["sites"] = sites;
  json["plants"] = plants;
  json["plants_by_species"] = by_species;
  json["tiles"] = tiles;
  json["corner_conflicts"] = conflicts;
  json["corner_removed"] = removed;
  json["neighbourhood_passes"] = passes;
  json["layers"] = layers;
  const base::Box extent = simulation.ecosystem.extent;
  json["extent"] = {{"west", extent.west}, {"south", extent.south}, {"east", extent.east}, {"north", extent.north}};
  const fields::FrameReport& frame = simulation.report.frame;
  if (frame.centre) {
    json["centre"] = {
        {"latitude", frame.centre->latitude_deg}, {"longitude", frame.centre->longitude_deg}, {"mgrs", frame.mgrs}};
    json["frame"] = {{"convergence_deg", frame.convergence_deg},
                     {"least_scale", frame.least_scale},
                     {"most_scale", frame.most_scale},
                     {"curvature_drop_m", frame.curvature_drop_m}};
  }
  Json seconds = Json::object();
  for (const auto& [stage, time] : simulation.report.seconds) seconds[stage] = time;
  seconds["total"] = total;
  json["seconds"] = seconds;
  json["peak_rss_bytes"] = base::peak_rss_bytes();
  json["threads"] = threads;
  json["seed"] = scenario.seed;
  json["version"] = version;
  json["config_sha256"] = scenario.sha256;
  return json;
}

void print_summary(const Simulation& simulation, const std::vector<Path>& outputs, double total) {
  std::uint64_t sites = 0, plants = 0, conflicts = 0, removed = 0;
  std::vector<std::pair<std::uint64_t, std::string>> species;
  for (std::size_t i = 0; i < simulation.report.layers.size(); ++i) {
    const LayerReport& layer = simulation.report.layers[i];
    sites += layer.sites;
    plants += layer.plants;
    conflicts += layer.corners.conflicts;
    removed += layer.corners.removed;
    for (std::size_t s = 0; s < layer.plants_by_species.size(); ++s) {
      species.emplace_back(layer.plants_by_species[s], simulation.ecosystem.layers[i].species[s].name);
    }
  }
  std::stable_sort(species.begin(), species.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  const ecosystem::Ecosystem& e = simulation.ecosystem;
  const fields::FrameReport& frame = simulation.report.frame;
  fmt::print("place    {}, {:.2f} x {:.2f} km{}\n", e.name, e.extent.width() / 1000, e.extent.height() / 1000,
             frame.centre
                 ? fmt::format(", about {:.4f}, {:.4f}", frame.centre->latitude_deg, frame.centre->longitude_deg)
                 : "");
  fmt::print("plants   {} on {} sites, {} species\n", grouped(plants), grouped(sites), species.size());
  std::string most;
  for (std::size_t i = 0; i < species.size() && i < 4; ++i) {
    const double share = plants > 0 ? 100.0 * static_cast<double>(species[i].first) / static_cast<double>(plants) : 0;
    most += fmt::format("{}{} {:.0f} %", i ? ", " : "", species[i].second, share);
  }
  fmt::print("most     {}\n", most);
  for (const LayerReport& layer : simulation.report.layers) {
    for (const auto& [field, share] : layer.no_data) {
      fmt::print("no data  field \"{}\" has none on {:.1f} % of the sites of layer \"{}\"\n", field, 100 * share,
                 layer.name);
    }
  }
  fmt::print("corners  {} overlaps, {} plants gave way\n", grouped(conflicts), grouped(removed));
  fmt::print("time     {:.2f} s, {} of memory at most\n", total, bytes_text(base::peak_rss_bytes()));
  for (const Path& output : outputs) {
    fmt::print("wrote    {} ({})\n", output.string(), bytes_text(std::filesystem::file_size(output)));
  }
}

}  // namespace

void run(const RunOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const auto passed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  const base::ThreadLimit limit(options.common.threads);
  const base::Progress progress = console_progress(options.common);

  const config::Scenario scenario = load(options.scenario);
  const Path output = options.output.value_or(default_output(options.scenario.ecosystem));
  std::vector<Path> outputs{output};
  if (options.svg) outputs.push_back(*options.svg);
  if (options.png) outputs.push_back(*options.png);
  for (const auto& [format, path] : options.exports) outputs.push_back(path);
  const std::vector<Path> inputs = inputs_of(scenario);
  check_outputs(outputs, inputs);

  // Maps of the place can be exported only if they are kept.
  bool probabilities = options.probabilities;
  for (const exports::Format& format : exports::formats()) {
    probabilities |= format.maps && options.exports.contains(format.name);
  }
  Simulation simulation = simulate(scenario, {probabilities, progress});
  const ecosystem::Ecosystem& grown = simulation.ecosystem;
  const auto timed = [&](const char* stage, const auto& write) {
    const double before = passed();
    write();
    simulation.report.seconds.emplace_back(stage, passed() - before);
  };
  timed("write", [&] { ecosystem::write(grown, output, inputs, progress); });
  const bool pictures = options.png || options.svg;
  if (pictures) {
    timed("pictures", [&] {
      base::report(progress, "pictures", 0);
      if (options.png) exports::write_png(grown, {}, *options.png);
      if (options.svg) exports::write_svg(grown, {}, *options.svg);
    });
  }
  if (!options.exports.empty()) {
    timed("export", [&] {
      for (const auto& [format, path] : options.exports) exports::export_to(grown, format, path, progress);
    });
  }
  end_progress(options.common);
  if (options.common.json) {
    fmt::print("{}\n", report_json(scenario, simulation, base::thread_count(), passed()).dump(2));
  } else if (!options.common.quiet) {
    print_summary(simulation, outputs, passed());
  }
}

}  // namespace silvasim::commands
