// <plants>: species, their measures and properties.
#include <array>
#include <map>

#include "silvasim/config/loading.h"
#include "silvasim/config/value.h"

namespace silvasim::config {

namespace {

// Twelve colours that stay apart in a map, greens first, for species that name none.
constexpr std::array<std::uint32_t, 12> default_colours = {0x1b7837, 0xd95f02, 0x1f78b4, 0x8dd35f, 0x7b3294, 0xe6ab02,
                                                           0x00a087, 0xc51b7d, 0x6b4c2a, 0x66c2e0, 0xb2182b, 0x4d4d4d};

PropertySettings read_property(Loading& loading, const Node& node) {
  PropertySettings property;
  property.name = node.string("name");
  if (node.children.size() == 1) {
    property.response = node.children.front();
  } else {
    loading.error(node.place, "<property name=\"" + property.name + "\"> needs one element that says the response" +
                                  (node.children.empty() ? ", like <MinMax min=\"0.2\" max=\"0.5\"/>"
                                                         : ", has " + std::to_string(node.children.size())));
  }
  return property;
}

SpeciesSettings read_species(Loading& loading, const Node& node, std::size_t number) {
  SpeciesSettings species;
  species.place = node.place;
  species.common_name = node.string("common");
  species.colour = node.has("colour") ? static_cast<std::uint32_t>(node.number("colour"))
                                      : default_colours[number % default_colours.size()];
  const Node* model = node.child("Model");
  if (model) {
    species.model = model->text;
    species.model_radius_m = model->number("radius");
    species.height_m = model->has("height") ? model->number("height") : 4 * species.model_radius_m;
    species.stem_radius_m = model->has("stem") ? model->number("stem") : species.model_radius_m / 20;
    if (species.stem_radius_m >= species.model_radius_m) {
      loading.error(model->place_of("stem"), "the stem's radius is not smaller than the crown's");
    }
  }
  species.name = plant_name(node);
  if (species.name.empty())
    loading.error(node.place, "<plant> has neither a name nor a <model> file to be named after");

  const Node* scale = node.child("Scale");
  species.most_scale = unbounded_scale;
  if (scale) {
    species.least_scale = scale->number("least");
    if (scale->has("most")) species.most_scale = scale->number("most");
    if (species.least_scale > species.most_scale)
      loading.error(scale->place, "<scale> reversed: least=\"" + to_text(species.least_scale) + "\" is above most=\"" +
                                      to_text(species.most_scale) + "\"");
  }
  const Node* neighbourhood = node.child("Neighbourhood");
  species.fon_radius_m = neighbourhood ? neighbourhood->number("radius") : 2 * species.model_radius_m;
  if (neighbourhood && species.fon_radius_m > 0 && species.fon_radius_m <= species.stem_radius_m) {
    loading.error(neighbourhood->place, "<neighbourhood>: the radius is not larger than the stem's");
  }

  std::map<std::string, base::Place> seen;
  for (const Node* property : node.all("Property")) {
    const auto [first, is_new] = seen.emplace(property->string("name"), property->place);
    if (is_new) {
      species.properties.push_back(read_property(loading, *property));
    } else {
      loading.error(property->place, "property \"" + first->first + "\" stands twice in this plant; the first is at " +
                                         short_place(first->second));
    }
  }
  return species;
}

}  // namespace

std::string plant_name(const Node& plant) {
  const Node* model = plant.child("Model");
  if (plant.has("name") || !model) return plant.string("name");
  return std::filesystem::path(model->text).stem().string();
}

void read_plants(Loading& loading, const Node& plants, Scenario& scenario) {
  std::vector<std::string> layer_names;
  for (const LayerSettings& layer : scenario.layers) layer_names.push_back(layer.name);
  std::map<std::pair<std::size_t, std::string>, base::Place> seen;  // by layer and name
  std::size_t number = 0;
  for (const Node* node : plants.all("Plant")) {
    SpeciesSettings species = read_species(loading, *node, number++);
    const std::string& layer = node->string("layer");
    std::size_t index = 0;
    while (!layer.empty() && index < layer_names.size() && layer_names[index] != layer) ++index;
    if (index >= layer_names.size()) {
      loading.error(node->place_of("layer"), "plant \"" + species.name + "\" grows in the unknown layer \"" + layer +
                                                 "\"" + base::did_you_mean(layer, layer_names));
      continue;
    }
    // The same species may grow in several layers, as tree and as shrub.
    const auto [first, is_new] = seen.emplace(std::pair(index, species.name), species.place);
    if (!is_new && !species.name.empty()) {
      loading.error(species.place, "plant \"" + species.name + "\" stands twice in layer \"" + layer_names[index] +
                                       "\"; the first is at " + short_place(first->second));
    }
    scenario.layers[index].species.push_back(std::move(species));
  }
  constexpr std::size_t most_species = 4096;
  for (const LayerSettings& layer : scenario.layers) {
    if (layer.species.empty()) loading.error(layer.place, "no plant grows in layer \"" + layer.name + "\"");
    if (layer.species.size() > most_species) {
      loading.error(layer.place,
                    "layer \"" + layer.name + "\" has more than " + std::to_string(most_species) + " plants");
      // What follows needs room in the square of their number.
      throw base::ConfigError(std::move(loading.errors));
    }
  }
}

}  // namespace silvasim::config
