#include "silvasim/explain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "silvasim/base/error.h"
#include "silvasim/evaluators/network.h"
#include "silvasim/population/influence_field.h"

namespace silvasim {

namespace {

double distance(base::Point a, base::Point b) { return std::hypot(a.x - b.x, a.y - b.y); }

std::size_t best_of(const std::vector<float>& probability) {
  return static_cast<std::size_t>(std::max_element(probability.begin(), probability.end()) - probability.begin());
}

// What the plants that acted on the site did to its subject.
void explain_neighbours(const GrownLayer& grown, const config::LayerSettings& settings, SiteExplanation& explanation) {
  if (explanation.subject == ecosystem::no_plant) return;
  const population::Influences influences(settings);
  for (const population::ActingPlant& plant : grown.acting) {
    const float influence = influences.on_others(plant.species)[explanation.subject];
    if (influence == 0) continue;
    explanation.neighbours.push_back({plant.species, static_cast<double>(plant.distance_m), plant.strength,
                                      std::max(0.0f, 1 + influence * plant.strength)});
  }
  std::sort(explanation.neighbours.begin(), explanation.neighbours.end(),
            [](const NeighbourEffect& a, const NeighbourEffect& b) { return a.distance_m < b.distance_m; });
}

void explain_corner(const GrownLayer& grown, const fields::FieldSet& fields, SiteExplanation& explanation) {
  if (!explanation.stood_before_corners || explanation.plant != ecosystem::no_plant) return;
  const evaluators::SitePlace& here = *grown.watched;
  const auto look = [&](const evaluators::SitePlace& other) {
    const double d = distance(other.at, here.at);
    const bool rival = other.index != here.index && grown.plants[other.index] != ecosystem::no_plant &&
                       d < static_cast<double>(other.radius_m) + static_cast<double>(here.radius_m);
    if (rival && (!explanation.gave_way_to || d < explanation.gave_way_to->distance_m)) {
      explanation.gave_way_to = NeighbourEffect{grown.plants[other.index], d, 0, 1};
    }
  };
  evaluators::for_sites_around(grown.ground(fields), here.at, 2 * grown.tile_set.most_radius_m, look);
}

std::string text_of(const evaluators::TraceRow& row, std::size_t species) {
  if (!row.value && !row.field.empty()) return "field \"" + row.field + "\" has no data there";
  std::string text = row.tag;
  if (row.value) text += fmt::format(" of {} = {:.4g}", row.field, *row.value);
  return text + fmt::format(" gives {:.3g}", *row.result[species]);
}

// The step at which a species was ruled out; the number of steps where it was not.
std::size_t ruled_out_at(const SiteExplanation& e, std::size_t species) {
  std::size_t step = 0;
  while (step < e.steps.size() && e.steps[step].running[species] >= 0) ++step;
  return step;
}

// What ruled a species out, or brought its probability down most.
std::string strongest_reason(const SiteExplanation& e, std::size_t species) {
  const std::size_t out = ruled_out_at(e, species);
  if (out < e.steps.size()) return text_of(e.steps[out], species);
  const evaluators::TraceRow* worst = nullptr;
  for (const evaluators::TraceRow& row : e.steps) {
    const bool evaluator = row.tag != "NormalizeEvaluator" && row.tag != "length" && row.tag != "product";
    const bool known = row.value || row.field.empty();
    if (!row.result[species] || !evaluator || !known) continue;
    if (!worst || *row.result[species] < *worst->result[species]) worst = &row;
  }
  return worst ? text_of(*worst, species) : "no evaluator acts on it";
}

// What the probability was before the neighbours; nothing where none acted.
std::string neighbours_text(const SiteExplanation& e) {
  if (e.neighbours.empty()) return "";
  return fmt::format(", which was {:.3g} before the neighbours acted", e.abiotic_probability);
}

std::string nothing_can_grow(const SiteExplanation& e) {
  if (e.subject != ecosystem::no_plant) {
    return fmt::format(
        "Nothing stands here: the place suits {} best, with a probability of {:.3g}, but the "
        "neighbours leave no plant a chance.",
        e.species[e.subject], e.abiotic_probability);
  }
  // The one that came furthest tells most.
  std::size_t furthest = 0;
  for (std::size_t s = 1; s < e.species.size(); ++s) {
    if (ruled_out_at(e, s) > ruled_out_at(e, furthest)) furthest = s;
  }
  return "Nothing stands here, because no plant can grow on this site; for " + e.species[furthest] + ", " +
         strongest_reason(e, furthest) + ".";
}

std::string sentence(const SiteExplanation& e, config::Selection selection) {
  if (e.outside) return "Nothing stands here, because the site lies outside the scene.";
  if (e.candidate == ecosystem::no_plant) return nothing_can_grow(e);
  const std::string name = e.species[e.candidate];
  const std::string chance = fmt::format("a probability of {:.3g}", e.probability) + neighbours_text(e);
  const bool drawn = selection == config::Selection::weighted;
  if (e.plant != ecosystem::no_plant) {
    if (!drawn) return name + " stands here, because of all plants it suits the site best, with " + chance + ".";
    const std::size_t best = best_of(e.abiotic);
    const std::string other = best == e.candidate ? ""
                                                  : fmt::format("; the place alone suits {} best, with {:.3g}",
                                                                e.species[best], e.abiotic[best]);
    return name + " stands here, because it was drawn among the plants that can, with " + chance + other + ".";
  }
  if (!e.stood_before_corners) {
    return "Nothing stands here: " + name + (drawn ? " was drawn for the site" : " would suit the site best") +
           ", but it had " + chance + ", and chance went against it; " + strongest_reason(e, e.candidate) + ".";
  }
  return fmt::format(
      "Nothing stands here: {} would, but its crown overlaps {} across a tile corner, which stayed.", name,
      e.gave_way_to ? e.species[e.gave_way_to->species] + fmt::format(", {:.1f} m away", e.gave_way_to->distance_m)
                    : "another plant");
}

SiteExplanation explain_layer(const config::Scenario& scenario, std::size_t index, const fields::FieldSet& fields,
                              const GrownLayer& grown, base::Point at) {
  const config::LayerSettings& settings = scenario.layers[index];
  if (!grown.watched) throw base::Error("the tiles hold no sites");
  const evaluators::SitePlace& here = *grown.watched;
  SiteExplanation explanation;
  explanation.layer = settings.name;
  for (const config::SpeciesSettings& species : settings.species) explanation.species.push_back(species.name);
  explanation.site = here.at;
  explanation.geographic = fields::geographic_from_scene(fields.frame, here.at);
  explanation.distance_m = distance(here.at, at);
  explanation.column = here.column;
  explanation.row = here.row;
  explanation.tile = grown.tiling.at(here.column, here.row);
  explanation.site_id = static_cast<std::uint32_t>(here.site);
  explanation.radius_m = here.radius_m;

  // Follow the pipeline on this one site.
  const evaluators::Network network(scenario, index);
  evaluators::SiteColumns site;
  site.x = {here.at.x};
  site.y = {here.at.y};
  site.radius_m = {here.radius_m};
  site.sample(network, fields);
  explanation.outside = site.outside[0];
  explanation.steps = evaluators::trace(network, scenario, site, grown.suitability.maxima);

  // What the simulation decided.
  const std::size_t count = grown.suitability.species;
  const float* abiotic = grown.suitability.probability.data() + here.index * count;
  explanation.abiotic.assign(abiotic, abiotic + count);
  explanation.plant = grown.plants[here.index];
  explanation.stood_before_corners = grown.before_corners.plants[here.index] != ecosystem::no_plant;
  explanation.probability = grown.before_corners.probability[here.index];
  explanation.candidate = grown.before_corners.candidates[here.index];
  explanation.subject = explanation.candidate;
  if (explanation.subject == ecosystem::no_plant && !explanation.outside) {
    const std::size_t best = best_of(explanation.abiotic);
    if (abiotic[best] > 0) explanation.subject = static_cast<ecosystem::PlantId>(best);
  }
  if (explanation.subject != ecosystem::no_plant) explanation.abiotic_probability = abiotic[explanation.subject];
  explain_neighbours(grown, settings, explanation);
  explain_corner(grown, fields, explanation);
  explanation.sentence = sentence(explanation, settings.selection);
  return explanation;
}

}  // namespace

std::vector<SiteExplanation> explain(const config::Scenario& scenario, base::Point at, bool degrees,
                                     const base::Progress& progress) {
  if (auto errors = evaluators::check(scenario); !errors.empty()) throw base::ConfigError(std::move(errors));
  const fields::FieldSet fields = fields::load_fields(scenario.scene, scenario.fields, progress);
  if (degrees) {
    const auto point = fields::scene_from_geographic(fields.frame, {at.y, at.x});
    if (!point) throw base::Error("the scene has no place on the earth; give the point in its own metres");
    at = *point;
  }
  const base::Box extent = fields.frame.extent;
  if (!extent.contains(at)) {
    throw base::Error(
        fmt::format("the point {}, {} lies outside the scene, which reaches from {:.1f} to {:.1f} (x) and {:.1f} to "
                    "{:.1f} (y)",
                    at.x, at.y, extent.west, extent.east, extent.south, extent.north));
  }
  std::vector<SiteExplanation> explanations;
  std::vector<std::pair<std::string, double>> seconds;
  for (std::size_t layer = 0; layer < scenario.layers.size(); ++layer) {
    const GrownLayer grown = grow_layer(scenario, layer, fields, progress, seconds, at);
    explanations.push_back(explain_layer(scenario, layer, fields, grown, at));
  }
  return explanations;
}

}  // namespace silvasim
