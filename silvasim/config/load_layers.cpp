// The vegetation layers: tiles, pipeline, establishment, neighbourhoods, corners.
#include <algorithm>
#include <filesystem>
#include <map>

#include "silvasim/config/loading.h"
#include "silvasim/config/value.h"

namespace silvasim::config {

namespace {

bool is_step(const Dialect& dialect, const Node& node) {
  const std::string& type = node.rule->type;
  return type == "Product" || type == "Length" ||
         std::find(dialect.evaluators.begin(), dialect.evaluators.end(), type) != dialect.evaluators.end();
}

TileSettings read_tiles(Loading& loading, const Node& layer) {
  TileSettings tiles;
  tiles.place = layer.place;
  const Node* node = layer.child("Tiles");
  if (!node) return tiles;
  tiles.place = node->place;
  tiles.side_m = node->number("side");
  tiles.colours = static_cast<int>(node->number("colours"));
  tiles.variants = static_cast<int>(node->number("variants"));
  tiles.mode = node->string("mode") == "seamless" ? TileMode::seamless : TileMode::paper;
  tiles.coverage = node->number("coverage");
  if (const Node* radii = node->child("Radii")) {
    tiles.least_radius_m = radii->number("least");
    tiles.most_radius_m = radii->number("most");
    const std::string& distribution = radii->string("distribution");
    tiles.distribution = distribution == "normal"      ? RadiusDistribution::normal
                         : distribution == "lognormal" ? RadiusDistribution::lognormal
                                                       : RadiusDistribution::uniform;
    if (radii->has("mean")) tiles.mean_radius_m = radii->number("mean");
    if (radii->has("deviation")) tiles.deviation_radius_m = radii->number("deviation");
    if (tiles.least_radius_m > tiles.most_radius_m)
      loading.error(radii->place, "<radii> reversed: least=\"" + to_text(tiles.least_radius_m) +
                                      " m\" is above most=\"" + to_text(tiles.most_radius_m) + " m\"");
    if (tiles.distribution == RadiusDistribution::uniform && (radii->given("mean") || radii->given("deviation"))) {
      loading.error(radii->place,
                    "<radii>: mean and deviation are used with distribution=\"normal\" or \"lognormal\" only");
    }
  }
  if (tiles.variants > tiles.colours - 1) {
    loading.error(node->place_of("variants"), "<tiles> variants: " + std::to_string(tiles.variants) +
                                                  " is above colours - 1 = " + std::to_string(tiles.colours - 1));
  }
  if (tiles.side_m <= 8 * tiles.most_radius_m) {
    loading.error(node->place, "<tiles>: side " + to_text(tiles.side_m) +
                                   " m is not larger than 8 times the largest radius, " +
                                   to_text(8 * tiles.most_radius_m) + " m; enlarge side or lessen radii");
  }
  return tiles;
}

// Turns the name references of one evaluator into indices.
void resolve_evaluator(Loading& loading, const Node& node, const Scenario& scenario, const LayerSettings& layer,
                       StepSettings& step) {
  const std::string tag = "<" + node.rule->tag + ">";
  if (node.knows("lethal")) {
    step.lethal = node.boolean("lethal");
    step.floor = node.number("floor");
  }

  if (const Node* reference = node.child("DatafieldReference")) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < scenario.fields.size(); ++i) {
      names.push_back(scenario.fields[i].name);
      if (names.back() == reference->text) step.field = static_cast<int>(i);
    }
    if (step.field < 0 && !reference->text.empty()) {
      loading.error(reference->place, tag + " uses the unknown data field \"" + reference->text + "\"" +
                                          base::did_you_mean(reference->text, names));
    }
  }

  std::vector<std::string> names;
  for (const SpeciesSettings& species : layer.species) names.push_back(species.name);
  const std::vector<const Node*> only = node.all("PlantReference");
  step.applies.assign(names.size(), only.empty());
  for (const Node* reference : only) {
    const auto found = std::find(names.begin(), names.end(), reference->text);
    if (found != names.end()) {
      step.applies[static_cast<std::size_t>(found - names.begin())] = true;
    } else {
      loading.error(reference->place, tag + " is limited to the unknown plant \"" + reference->text + "\"" +
                                          base::did_you_mean(reference->text, names));
    }
  }

  step.properties.assign(names.size(), -1);
  const Node* reference = node.child("PropertyReference");
  if (!reference) return;
  for (std::size_t s = 0; s < layer.species.size(); ++s) {
    if (!step.applies[s]) continue;
    const auto& properties = layer.species[s].properties;
    std::vector<std::string> known;
    for (std::size_t i = 0; i < properties.size(); ++i) {
      known.push_back(properties[i].name);
      if (known.back() == reference->text) step.properties[s] = static_cast<int>(i);
    }
    if (step.properties[s] < 0) {
      loading.error(layer.species[s].place, "plant \"" + layer.species[s].name + "\" has no property \"" +
                                                reference->text + "\", which " + tag + " at " +
                                                short_place(node.place) + " asks for" +
                                                base::did_you_mean(reference->text, known));
    }
  }
}

StepSettings read_step(Loading& loading, const Node& node, const Scenario& scenario, const LayerSettings& layer) {
  StepSettings step;
  step.place = node.place;
  step.node = node;
  const auto& evaluators = loading.dialect.evaluators;
  const auto found = std::find(evaluators.begin(), evaluators.end(), node.rule->type);
  if (found != evaluators.end()) {
    step.kind = StepSettings::Kind::evaluator;
    step.evaluator = static_cast<int>(found - evaluators.begin());
    resolve_evaluator(loading, node, scenario, layer, step);
    return step;
  }
  step.kind = node.rule->type == "Length" ? StepSettings::Kind::length : StepSettings::Kind::product;
  for (const Node& child : node.children) step.steps.push_back(read_step(loading, child, scenario, layer));
  if (step.steps.empty()) loading.error(node.place, "<" + node.rule->tag + "> is empty");
  return step;
}

// The explicit pipeline, or the evaluators that stand right in the layer or the ecosystem, as in the paper's fragments.
StepSettings read_pipeline(Loading& loading, const Node& node, const Scenario& scenario, const LayerSettings& layer) {
  StepSettings pipeline;
  pipeline.kind = StepSettings::Kind::product;
  pipeline.place = node.place;
  const Node* written = node.child("Pipeline");
  if (written) {
    pipeline.place = written->place;
    if (written->string("combine") == "length") pipeline.kind = StepSettings::Kind::length;
  }
  for (const Node& child : written ? written->children : node.children) {
    if (is_step(loading.dialect, child)) pipeline.steps.push_back(read_step(loading, child, scenario, layer));
  }
  for (const Node& child : node.children) {
    if (written && is_step(loading.dialect, child)) {
      loading.error(child.place, "<" + child.rule->tag + "> stands beside the <pipeline> at " +
                                     short_place(written->place) + "; move it inside");
    }
  }
  if (pipeline.steps.empty()) {
    loading.error(pipeline.place, "layer \"" + layer.name + "\" has no evaluators; <pipeline> needs one at least");
  }
  return pipeline;
}

// Who acts on whom. A pair named outright beats one with a *, and either *-form beats from="*" on="*".
class InfluenceMatrix {
 public:
  InfluenceMatrix(Loading& loading, const LayerSettings& layer, std::vector<std::string> elsewhere)
      : loading_(loading), layer_(layer), elsewhere_(std::move(elsewhere)) {
    for (const SpeciesSettings& species : layer.species) names_.push_back(species.name);
    values_.assign(names_.size() * names_.size(), 0);
    ranks_.assign(values_.size(), -1);
    places_.resize(values_.size());
  }

  void add(const std::string& from, const std::string& on, double value, const base::Place& place) {
    const std::vector<std::size_t> actors = matching(from, place), targets = matching(on, place);
    const int rank = (from != "*") + (on != "*");
    for (std::size_t a : actors) {
      for (std::size_t t : targets) {
        const std::size_t pair = a * names_.size() + t;
        if (ranks_[pair] == rank && values_[pair] != value) {
          loading_.error(place, "the influence of \"" + names_[a] + "\" on \"" + names_[t] + "\" is said already at " +
                                    short_place(places_[pair]));
          return;
        }
        if (ranks_[pair] > rank) continue;
        values_[pair] = value;
        ranks_[pair] = rank;
        places_[pair] = place;
      }
    }
  }

  std::vector<double> values() const { return values_; }

 private:
  std::vector<std::size_t> matching(const std::string& name, const base::Place& place) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (name == "*" || names_[i] == name) found.push_back(i);
    }
    const bool other_layer = std::find(elsewhere_.begin(), elsewhere_.end(), name) != elsewhere_.end();
    if (found.empty() && other_layer) {
      loading_.error(place, "<influence>: plant \"" + name + "\" grows in another layer than \"" + layer_.name + "\"");
    } else if (found.empty()) {
      loading_.error(place, "<influence> names the unknown plant \"" + name + "\"" + base::did_you_mean(name, names_));
    }
    return found;
  }

  Loading& loading_;
  const LayerSettings& layer_;
  std::vector<std::string> names_, elsewhere_;
  std::vector<double> values_;
  std::vector<int> ranks_;
  std::vector<base::Place> places_;
};

NeighbourhoodSettings read_neighbourhoods(Loading& loading, const Node& node, const Node& plants,
                                          const Scenario& scenario, const LayerSettings& layer) {
  NeighbourhoodSettings settings;
  const Node* written = node.child("Neighbourhoods");
  std::vector<std::string> elsewhere;
  for (const LayerSettings& other : scenario.layers) {
    for (const SpeciesSettings& species : other.species) {
      if (&other != &layer) elsewhere.push_back(species.name);
    }
  }
  InfluenceMatrix matrix(loading, layer, std::move(elsewhere));
  if (written) {
    settings.enabled = true;
    if (written->has("cell")) settings.cell_m = written->number("cell");
    settings.passes = static_cast<int>(written->number("passes"));
    settings.fmin = written->number("fmin");
    for (const Node* influence : written->all("Influence")) {
      matrix.add(influence->string("from"), influence->string("on"), influence->number("value"), influence->place);
    }
  }
  for (const Node* plant : plants.all("Plant")) {
    const std::string name = plant_name(*plant);
    const bool here = std::any_of(layer.species.begin(), layer.species.end(),
                                  [&](const SpeciesSettings& species) { return species.place == plant->place; });
    if (!here) continue;
    for (const Node* influence : plant->all("PlantInfluence")) {
      if (!written) {
        loading.error(influence->place,
                      "<influence> needs <neighbourhoods> in layer \"" + layer.name + "\", which has none");
      }
      matrix.add(name, influence->string("on"), influence->number("value"), influence->place);
    }
  }
  settings.influence = matrix.values();
  return settings;
}

}  // namespace

std::vector<const Node*> layer_nodes(const Node& ecosystem) {
  std::vector<const Node*> nodes = ecosystem.all("Layer");
  if (nodes.empty()) nodes.push_back(&ecosystem);
  return nodes;
}

void read_layers(Loading& loading, const Node& ecosystem, Scenario& scenario) {
  const std::vector<const Node*> nodes = layer_nodes(ecosystem);
  const bool explicit_layers = nodes.front() != &ecosystem;
  // With <layer> elements, nothing of a layer may stand outside of them.
  for (const Node& child : ecosystem.children) {
    const std::string& type = child.rule->type;
    const bool of_layer = is_step(loading.dialect, child) || type == "Tiles" || type == "Pipeline" ||
                          type == "Establishment" || type == "Neighbourhoods" || type == "Corners";
    if (explicit_layers && of_layer) {
      loading.error(child.place,
                    "<" + child.rule->tag + "> stands beside <layer> elements; move it into the one it is for");
    }
  }
  std::map<std::string, base::Place> seen;
  for (const Node* node : nodes) {
    LayerSettings layer;
    layer.place = node->place;
    layer.name = explicit_layers ? node->string("name") : "plants";
    const auto [first, is_new] = seen.emplace(layer.name, layer.place);
    if (!is_new) {
      loading.error(layer.place,
                    "layer \"" + layer.name + "\" stands twice; the first is at " + short_place(first->second));
    }
    layer.tiles = read_tiles(loading, *node);
    if (const Node* establishment = node->child("Establishment")) {
      layer.selection = establishment->string("selection") == "weighted" ? Selection::weighted : Selection::most_likely;
      layer.chance = establishment->string("chance") == "certain" ? Chance::certain : Chance::stochastic;
    }
    if (const Node* corners = node->child("Corners")) {
      layer.corners = corners->string("solver") == "paper" ? CornerSolver::paper : CornerSolver::optimal;
    }
    scenario.layers.push_back(std::move(layer));
  }
}

void read_pipelines(Loading& loading, const Node& ecosystem, const Node& plants, Scenario& scenario) {
  const std::vector<const Node*> nodes = layer_nodes(ecosystem);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    LayerSettings& layer = scenario.layers[i];
    layer.pipeline = read_pipeline(loading, *nodes[i], scenario, layer);
    layer.neighbourhoods = read_neighbourhoods(loading, *nodes[i], plants, scenario, layer);
  }
}

}  // namespace silvasim::config
