// silvasim explain: why a plant stands at a point, or none.
#include "silvasim/explain.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "silvasim/base/error.h"
#include "silvasim/base/parallel.h"
#include "silvasim/commands/commands.h"
#include "silvasim/commands/console.h"

namespace silvasim::commands {

namespace {

using Json = nlohmann::ordered_json;

std::string step_name(const evaluators::TraceRow& row) {
  std::string name(static_cast<std::size_t>(row.depth) * 2, ' ');
  name += row.tag;
  if (!row.field.empty())
    name += row.value ? fmt::format(" {} = {:.4g}", row.field, *row.value) : " " + row.field + ": no data";
  return name;
}

std::string number(float value) { return value < 0 ? "out" : fmt::format("{:.3f}", value); }

void print_layer(const SiteExplanation& e) {
  fmt::print("layer {}: site {} of tile {} at tile position column {}, row {}; radius {:.2f} m\n", e.layer, e.site_id,
             e.tile, e.column, e.row, e.radius_m);
  fmt::print("  at {:.2f}, {:.2f}", e.site.x, e.site.y);
  if (e.geographic)
    fmt::print(" (latitude {:.6f}, longitude {:.6f})", e.geographic->latitude_deg, e.geographic->longitude_deg);
  fmt::print(", {:.2f} m from the point asked for\n", e.distance_m);
  for (std::size_t s = 0; s < e.species.size(); ++s) {
    fmt::print("\n  {}{}\n", e.species[s], s == e.candidate ? "  <- the site's candidate" : "");
    for (const evaluators::TraceRow& row : e.steps) {
      if (!row.result[s]) continue;
      fmt::print("    {:<48} {:>8}   so far {}\n", step_name(row), number(*row.result[s]), number(row.running[s]));
    }
    fmt::print("    {:<48} {:>8}\n", "from the place alone", number(e.abiotic[s]));
  }
  if (!e.neighbours.empty()) {
    fmt::print("\n  neighbours act on {}: {:.3f} before, {:.3f} after\n", e.species[e.subject], e.abiotic_probability,
               e.probability);
    for (const NeighbourEffect& n : e.neighbours) {
      fmt::print("    {:<30} {:6.1f} m away, field {:.3f}, times {:.3f}\n", e.species[n.species], n.distance_m,
                 n.strength, n.factor);
    }
  }
  if (e.stood_before_corners) {
    fmt::print("\n  corner: {}\n",
               e.plant == ecosystem::no_plant ? "it gave way" : "nothing to give way to, or it stayed");
  }
  fmt::print("\n{}\n", e.sentence);
}

Json as_json(const SiteExplanation& e) {
  Json json;
  json["layer"] = e.layer;
  json["site"] = {
      {"x", e.site.x},           {"y", e.site.y},     {"radius_m", e.radius_m}, {"distance_m", e.distance_m},
      {"tile_column", e.column}, {"tile_row", e.row}, {"tile", e.tile},         {"id", e.site_id},
      {"outside", e.outside}};
  if (e.geographic) {
    json["site"]["latitude"] = e.geographic->latitude_deg;
    json["site"]["longitude"] = e.geographic->longitude_deg;
  }
  const auto probability = [](float p) { return p < 0 ? Json("excluded") : Json(p); };
  json["species"] = Json::array();
  for (std::size_t s = 0; s < e.species.size(); ++s) {
    Json steps = Json::array();
    for (const evaluators::TraceRow& row : e.steps) {
      if (!row.result[s]) continue;
      Json step = {{"step", row.tag}, {"depth", row.depth}, {"line", row.place.line}};
      if (!row.field.empty()) {
        step["field"] = row.field;
        step["value"] = row.value ? Json(*row.value) : Json(nullptr);
      }
      step["result"] = *row.result[s];
      step["so_far"] = probability(row.running[s]);
      steps.push_back(std::move(step));
    }
    json["species"].push_back(
        {{"name", e.species[s]}, {"abiotic", probability(e.abiotic[s])}, {"steps", std::move(steps)}});
  }
  const auto name = [&](ecosystem::PlantId id) {
    return id == ecosystem::no_plant ? Json(nullptr) : Json(e.species[id]);
  };
  json["candidate"] = name(e.candidate);
  json["subject"] = name(e.subject);
  json["abiotic_probability"] = e.abiotic_probability;
  json["probability"] = e.probability;
  json["neighbours"] = Json::array();
  for (const NeighbourEffect& n : e.neighbours) {
    json["neighbours"].push_back({{"species", e.species[n.species]},
                                  {"distance_m", n.distance_m},
                                  {"strength", n.strength},
                                  {"factor", n.factor}});
  }
  json["stood_before_corners"] = e.stood_before_corners;
  json["gave_way_to"] = e.gave_way_to ? name(e.gave_way_to->species) : Json(nullptr);
  json["plant"] = name(e.plant);
  json["sentence"] = e.sentence;
  return json;
}

}  // namespace

void explain_point(const ExplainOptions& options) {
  const base::ThreadLimit limit(options.common.threads);
  const config::Scenario scenario = load(options.scenario);
  const auto explanations =
      explain(scenario, {options.x, options.y}, options.degrees, console_progress(options.common));
  end_progress(options.common);
  if (options.common.json) {
    Json layers = Json::array();
    for (const SiteExplanation& e : explanations) layers.push_back(as_json(e));
    fmt::print("{}\n", Json{{"layers", layers}}.dump(2));
    return;
  }
  for (std::size_t i = 0; i < explanations.size(); ++i) {
    if (i > 0) fmt::print("\n");
    print_layer(explanations[i]);
  }
}

}  // namespace silvasim::commands
