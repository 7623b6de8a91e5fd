#include "ghosttile/cover/rule_xml.h"

#include <algorithm>

#include "ghosttile/cover/rasters.h"
#include "ghosttile/cover/rule.h"
#include "silvasim/config/value.h"

namespace ghosttile::cover {

namespace base = silvasim::base;
namespace config = silvasim::config;

namespace {

// Fine where crowns and stems have edges, coarse where the quantity is smooth. Powers of two, so that nodes lie at exact places.
constexpr double fine_m = 0.25, smooth_m = 0.5;

std::string tag_of(const config::Node& node) { return "<" + node.rule->tag + ">"; }

std::vector<std::string> words_of(const std::string& list) {
  std::vector<std::string> words;
  for (std::size_t first = 0; first <= list.size();) {
    const std::size_t end = std::min(list.find(',', first), list.size());
    words.push_back(config::trimmed(list.substr(first, end - first)));
    first = end + 1;
  }
  return words;
}

bool is_meant(const std::string& word, const PlantSpecies& species) {
  return word == species.name || word == genus_of(species.name) || (word == "broadleaf" && !species.habit.needles) ||
         (word == "needles" && species.habit.needles);
}

// "; did you mean ...?", or what there is, where that is little.
std::string hint(const std::string& word, const std::vector<std::string>& known,
                 const std::vector<std::string>& listed) {
  const std::string close = base::did_you_mean(word, known);
  if (!close.empty() || listed.empty() || listed.size() > 24) return close;
  std::string text = "; there are ";
  for (std::size_t i = 0; i < listed.size(); ++i) text += (i ? ", \"" : "\"") + listed[i] + "\"";
  return text;
}

double month_of(const config::Node& node, const Land& land) {
  return node.has("month") ? node.number("month") : land.options().month;
}

// All that a source of plants depends on.
std::string name_of(const config::Node& node, const Chosen& chosen, double month) {
  std::string name = node.rule->type;
  for (const config::AttributeRule& rule : node.rule->attributes) {
    if (rule.name == "species" || rule.name == "layer" || rule.name == "month") continue;
    const config::Value& value = node.values[static_cast<std::size_t>(&rule - node.rule->attributes.data())];
    if (const auto* number = std::get_if<double>(&value)) name += ' ' + config::to_text(*number);
    if (const auto* text = std::get_if<std::string>(&value)) name += ' ' + *text;
  }
  name += ' ' + config::to_text(month) + ' ';
  for (const bool yes : chosen.selection.species) name += yes ? '1' : '0';
  return name;
}

std::unique_ptr<const Filler> make_filler(const config::Node& node, Chosen chosen, double month) {
  const std::string& type = node.rule->type;
  const auto number = [&](const char* name) { return static_cast<float>(node.number(name)); };
  if (type == "CrownCover") return crown_cover(std::move(chosen), {number("reach"), number("rim"), {}});
  if (type == "Litter") {
    CrownCover cover{number("reach"), number("rim"), {}};
    for (const PlantSpecies& species : chosen.plants->species()) cover.strength.push_back(litter(species.habit, month));
    return crown_cover(std::move(chosen), std::move(cover));
  }
  if (type == "StemDistance") return stem_distance(std::move(chosen), number("most"));
  if (type == "StandDensity") {
    const bool stems = node.string("measure") == "stems";
    return stand_density(std::move(chosen), number("radius"),
                         stems ? DensityMeasure::stems : DensityMeasure::basal_area);
  }
  if (type == "Light") {
    Light settings;
    settings.month = month;
    settings.leaf_area = number("leafarea");
    return light(std::move(chosen), settings);
  }
  return nullptr;
}

std::shared_ptr<const Source> plant_source(const config::Node& node, Land& land,
                                           std::vector<base::Diagnostic>& errors) {
  const std::size_t before = errors.size();
  Chosen chosen = chosen_by(node, land, errors);
  if (errors.size() > before) return nullptr;
  const double month = node.knows("month") ? month_of(node, land) : 0;
  const bool smooth = node.rule->type == "StandDensity" || node.rule->type == "Light";
  return land.source(name_of(node, chosen, month), [&] {
    return on_lattice(make_filler(node, chosen, month), smooth ? smooth_m : fine_m, land.options().most_bytes_a_source);
  });
}

std::shared_ptr<const Source> named_field(const config::Node& node, Land& land, std::vector<base::Diagnostic>& errors) {
  std::vector<std::string> known;
  if (land.fields()) {
    for (const auto& field : land.fields()->fields) known.push_back(field.name);
  }
  const auto found = std::find(known.begin(), known.end(), node.text);
  if (found == known.end()) {
    base::add(errors, node.place,
              land.fields()
                  ? "there is no data field \"" + node.text + "\"" + hint(node.text, known, known)
                  : "there is no data field \"" + node.text + "\": the scene names no ecosystem.xml that has any");
    return nullptr;
  }
  const auto index = static_cast<std::size_t>(found - known.begin());
  return land.source("CoverDatafield " + node.text, [&] { return field_source(land.fields(), index); });
}

// Sources whose values are shares, to which no Property needs to answer.
bool is_share(const std::string& type) {
  return type == "CrownCover" || type == "Litter" || type == "Light" || type == "Patches";
}

std::optional<Factor> make_factor(const config::Node& response, Land& land, std::vector<base::Diagnostic>& errors) {
  const config::Node* source = nullptr;
  const config::Node* property = nullptr;
  const std::size_t before = errors.size();
  const auto& properties = silvasim::evaluators::property_types();
  for (const config::Node& child : response.children) {
    const bool answers = std::any_of(properties.begin(), properties.end(),
                                     [&](const auto& known) { return known.rule.type == child.rule->type; });
    const config::Node*& place = answers ? property : source;
    if (place) {
      base::add(errors, child.place,
                "<response> takes one " + std::string(answers ? "Property" : "source") + ": " + tag_of(child) +
                    " follows " + tag_of(*place) + "; put each into a <response> of its own");
    }
    place = &child;
  }
  if (!source) {
    base::add(errors, response.place,
              "<response> needs a source, such as <crowncover/>, <light/>, <slope/> or <datafield>");
  } else if (!property && !is_share(source->rule->type)) {
    base::add(errors, source->place,
              tag_of(*source) + " needs a Property that turns it into a share, such as <Trapezoid> or <Table>");
  }
  if (errors.size() > before) return std::nullopt;
  Factor factor;
  factor.source = make_source(*source, land, errors);
  if (property) {
    factor.response = silvasim::evaluators::make_response(*property, errors);
    factor.response_range.emplace(*property);
  }
  if (errors.size() > before) return std::nullopt;
  return factor;
}

}  // namespace

Chosen chosen_by(const config::Node& node, const Land& land, std::vector<base::Diagnostic>& errors) {
  const auto& species = land.plants()->species();
  const auto& layers = land.plants()->ecosystem().layers;
  std::vector<bool> meant(species.size(), true);
  if (!node.string("species").empty()) {
    meant.assign(species.size(), false);
    std::vector<std::string> known, names;
    for (const PlantSpecies& one : species) {
      if (std::find(names.begin(), names.end(), one.name) == names.end()) names.push_back(one.name);
      for (const std::string& name : {one.name, genus_of(one.name)}) {
        if (std::find(known.begin(), known.end(), name) == known.end()) known.push_back(name);
      }
    }
    known.insert(known.end(), {"broadleaf", "needles"});
    for (const std::string& word : words_of(node.string("species"))) {
      bool found = word == "broadleaf" || word == "needles";
      for (std::size_t s = 0; s < species.size(); ++s) {
        if (!is_meant(word, species[s])) continue;
        meant[s] = true;
        found = true;
      }
      if (found) continue;
      base::add(errors, node.place_of("species"),
                word.empty() ? "species: a name is missing between commas"
                             : "species: there is no \"" + word + "\" in this ecosystem" + hint(word, known, names));
    }
  }
  const std::string& layer = node.string("layer");
  if (!layer.empty()) {
    std::vector<std::string> known;
    for (const auto& one : layers) known.push_back(one.name);
    if (std::find(known.begin(), known.end(), layer) == known.end()) {
      base::add(errors, node.place_of("layer"),
                "layer: there is no \"" + layer + "\" in this ecosystem" + hint(layer, known, known));
    }
    for (std::size_t s = 0; s < species.size(); ++s) meant[s] = meant[s] && known[species[s].layer] == layer;
  }
  return {land.plants(), land.plants()->select(std::move(meant))};
}

std::shared_ptr<const Source> make_source(const config::Node& node, Land& land, std::vector<base::Diagnostic>& errors) {
  const std::string& type = node.rule->type;
  const auto ground = [&](GroundMeasure measure) {
    return land.source(type, [&] { return ground_source(land.plants()->ecosystem().terrain, measure); });
  };
  if (type == "CoverDatafield") return named_field(node, land, errors);
  if (type == "Elevation") return ground(GroundMeasure::elevation);
  if (type == "Slope") return ground(GroundMeasure::slope);
  if (type == "Northness") return ground(GroundMeasure::northness);
  if (type == "Eastness") return ground(GroundMeasure::eastness);
  if (type == "Month") return constant_source(static_cast<float>(land.options().month));
  if (type == "Patches") {
    const double size = node.number("size"), seed = node.number("seed");
    return land.source("Patches " + config::to_text(size) + ' ' + config::to_text(seed), [&] {
      // Four to eight nodes a width of the finest octave.
      double step = fine_m;
      while (step > size / 16) step /= 2;
      while (step * 2 <= size / 16) step *= 2;
      const std::uint64_t mixed = land.options().seed * 0x9E3779B97F4A7C15u + static_cast<std::uint64_t>(seed);
      return on_lattice(patches(mixed, size), step, land.options().most_bytes_a_source);
    });
  }
  return plant_source(node, land, errors);
}

std::shared_ptr<const density::Plane> make_rule(const config::Node& where, Land& land,
                                                std::vector<base::Diagnostic>& errors) {
  const std::size_t before = errors.size();
  std::vector<Factor> factors;
  for (const config::Node& child : where.children) {
    if (child.rule->type == "Where") {
      Factor factor;
      factor.rule = make_rule(child, land, errors);
      factors.push_back(std::move(factor));
    } else if (auto factor = make_factor(child, land, errors)) {
      factors.push_back(std::move(*factor));
    }
  }
  if (where.children.empty()) base::add(errors, where.place, "<where> needs a <response>");
  if (errors.size() > before) return nullptr;
  const std::string& word = where.string("combine");
  const Combine combine = word == "least" ? Combine::least : word == "greatest" ? Combine::greatest : Combine::product;
  return std::make_shared<Rule>(combine, std::move(factors));
}

}  // namespace ghosttile::cover
