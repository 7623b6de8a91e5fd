#include "silvasim/explain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "silvasim/base/error.h"
#include "silvasim/evaluators/network.h"
#include "silvasim/population/influence_field.h"

namespace silvasim {

namespace {

struct SitePlace {
  int column = 0, row = 0;
  std::size_t site = 0;
  std::uint64_t index = 0;
  base::Point at;
  float radius_m = 0;
};

// Visits the sites of the tiles within `reach_m` of a point.
template <typename Visit>
void for_sites_around(const GrownLayer& grown, base::Point at, double reach_m, Visit&& visit) {
  const double side = grown.tile_set.side_m;
  const auto tile = [&](double offset, int count) {
    return std::clamp(static_cast<int>(std::floor(offset / side)), 0, count - 1);
  };
  const int columns = grown.tiling.columns, rows = grown.tiling.rows;
  for (int row = tile(grown.north_west.y - at.y - reach_m, rows);
       row <= tile(grown.north_west.y - at.y + reach_m, rows); ++row) {
    for (int column = tile(at.x - grown.north_west.x - reach_m, columns);
         column <= tile(at.x - grown.north_west.x + reach_m, columns); ++column) {
      const std::size_t position = grown.tiling.position(column, row);
      const auto& sites = grown.tile_set.tiles[grown.tiling.tiles[position]].sites;
      const base::Point origin{grown.north_west.x + column * side, grown.north_west.y - (row + 1) * side};
      for (std::size_t k = 0; k < sites.size(); ++k) {
        visit(SitePlace{column,
                        row,
                        k,
                        grown.offsets[position] + k,
                        {origin.x + static_cast<double>(sites[k].x_m), origin.y + static_cast<double>(sites[k].y_m)},
                        sites[k].radius_m});
      }
    }
  }
}

double distance(base::Point a, base::Point b) { return std::hypot(a.x - b.x, a.y - b.y); }

SitePlace nearest_site(const GrownLayer& grown, base::Point at) {
  SitePlace best;
  double least = INFINITY;
  for_sites_around(grown, at, grown.tile_set.side_m, [&](const SitePlace& site) {
    const double d = distance(site.at, at);
    if (d < least) {
      least = d;
      best = site;
    }
  });
  if (!std::isfinite(least)) throw base::Error("the tiles hold no sites");
  return best;
}

void explain_neighbours(const GrownLayer& grown, const config::LayerSettings& settings, const SitePlace& here,
                        SiteExplanation& explanation) {
  if (!settings.neighbourhoods.enabled || explanation.candidate == ecosystem::no_plant) return;
  const population::Influences influences(settings);
  const float reach = influences.most_reach(static_cast<float>(grown.tile_set.most_radius_m));
  for_sites_around(grown, here.at, static_cast<double>(reach), [&](const SitePlace& other) {
    const ecosystem::PlantId plant = grown.before_corners.plants[other.index];
    if (other.index == here.index || plant == ecosystem::no_plant || !influences.acts(plant)) return;
    NeighbourEffect effect{plant, distance(other.at, here.at), 0, 1};
    effect.strength = influences.field(plant, other.radius_m).at(static_cast<float>(effect.distance_m));
    effect.factor = std::max(0.0f, 1 + influences.on_others(plant)[explanation.candidate] * effect.strength);
    if (effect.strength > 0 && effect.factor != 1) explanation.neighbours.push_back(effect);
  });
  std::sort(explanation.neighbours.begin(), explanation.neighbours.end(),
            [](const NeighbourEffect& a, const NeighbourEffect& b) { return a.distance_m < b.distance_m; });
}

void explain_corner(const GrownLayer& grown, const SitePlace& here, SiteExplanation& explanation) {
  if (!explanation.stood_before_corners || explanation.plant != ecosystem::no_plant) return;
  for_sites_around(grown, here.at, 2 * grown.tile_set.most_radius_m, [&](const SitePlace& other) {
    const double d = distance(other.at, here.at);
    const bool rival = other.index != here.index && grown.plants[other.index] != ecosystem::no_plant &&
                       d < static_cast<double>(other.radius_m) + static_cast<double>(here.radius_m);
    if (rival && (!explanation.gave_way_to || d < explanation.gave_way_to->distance_m)) {
      explanation.gave_way_to = NeighbourEffect{grown.plants[other.index], d, 0, 1};
    }
  });
}

// What brought a species' probability down most, for the sentence.
std::string strongest_reason(const SiteExplanation& explanation, std::size_t species) {
  const evaluators::TraceRow* worst = nullptr;
  for (const evaluators::TraceRow& row : explanation.steps) {
    if (!row.result[species] || row.tag == "NormalizeEvaluator" || row.tag == "length" || row.tag == "product")
      continue;
    if (!row.value && !row.field.empty()) return "field \"" + row.field + "\" has no data there";
    if (!worst || *row.result[species] < *worst->result[species]) worst = &row;
  }
  if (!worst) return "no evaluator acts on it";
  std::string text = worst->tag;
  if (worst->value) text += fmt::format(" of {} = {:.4g}", worst->field, *worst->value);
  return text + fmt::format(" gives {:.3g}", *worst->result[species]);
}

std::string sentence(const SiteExplanation& e) {
  if (e.outside) return "Nothing stands here, because the site lies outside the scene.";
  if (e.candidate == ecosystem::no_plant) {
    std::size_t best = 0;
    for (std::size_t s = 1; s < e.abiotic.size(); ++s) {
      if (e.abiotic[s] > e.abiotic[best]) best = s;
    }
    return "Nothing stands here, because no plant can grow on this site; for " + e.species[best] + ", " +
           strongest_reason(e, best) + ".";
  }
  const std::string name = e.species[e.candidate];
  const std::string neighbours =
      e.neighbours.empty()
          ? ""
          : fmt::format(" and the neighbours changed it from {:.3g} to {:.3g}", e.abiotic_probability, e.probability);
  if (e.plant != ecosystem::no_plant) {
    return fmt::format("{} stands here, because of all plants it suits the site best with a probability of {:.3g}{}.",
                       name, e.probability, neighbours);
  }
  if (!e.stood_before_corners) {
    return fmt::format(
        "Nothing stands here: {} would suit the site best, but its probability is only {:.3g}{}, and the draw "
        "went against it; {}.",
        name, e.probability, neighbours, strongest_reason(e, e.candidate));
  }
  return fmt::format(
      "Nothing stands here: {} would, but its crown overlaps {} across a tile corner, which stayed.", name,
      e.gave_way_to ? e.species[e.gave_way_to->species] + fmt::format(", {:.1f} m away", e.gave_way_to->distance_m)
                    : "another plant");
}

SiteExplanation explain_layer(const config::Scenario& scenario, std::size_t index, const fields::FieldSet& fields,
                              const GrownLayer& grown, base::Point at) {
  const config::LayerSettings& settings = scenario.layers[index];
  const SitePlace here = nearest_site(grown, at);
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
  if (explanation.candidate != ecosystem::no_plant) explanation.abiotic_probability = abiotic[explanation.candidate];
  explain_neighbours(grown, settings, here, explanation);
  explain_corner(grown, here, explanation);
  explanation.sentence = sentence(explanation);
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
    const GrownLayer grown = grow_layer(scenario, layer, fields, progress, seconds);
    explanations.push_back(explain_layer(scenario, layer, fields, grown, at));
  }
  return explanations;
}

}  // namespace silvasim
