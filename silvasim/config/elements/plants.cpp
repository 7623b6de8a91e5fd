// <plant> and what it holds.
#include "silvasim/config/elements/elements.h"

namespace silvasim::config {

using VT = ValueType;

std::vector<ElementRule> plant_rules() {
  return {
      {"Plant",
       "plant",
       "A species and how it responds to the place.",
       {attribute("name", VT::name, "scientific name; default: the model file's name"),
        attribute("common", VT::text, "common name"),
        attribute("colour", VT::colour, "in maps; default: by its number"),
        attribute("layer", VT::name, "the vegetation layer it grows in; default: the first")},
       {{"Model", 0, 1}, {"Scale", 0, 1}, {"Neighbourhood", 0, 1}, {"Property"}, {"PlantInfluence"}},
       VT::none,
       true,
       "<plant name=\"Quercus robur\" common=\"Pedunculate oak\" "
       "colour=\"#7a8b2c\"><model>./model/oak.obj</model></plant>"},
      {"Model",
       "model",
       "The plant's 3D model, and its measures at scale 1.",
       {within(attribute("radius", VT::length, "crown radius at scale 1", "4 m"), tiny),
        within(attribute("height", VT::length, "height at scale 1; default: four times the radius"), tiny),
        within(attribute("stem", VT::length, "stem radius at scale 1; default: a twentieth of the crown's"), 0)},
       {},
       VT::path,
       false,
       "<model radius=\"6 m\" height=\"28 m\" stem=\"0.4 m\">./model/oak.obj</model>"},
      {"Scale",
       "scale",
       "How much the model may be scaled: a site takes the plant if its radius / the model's lies in here.",
       {within(attribute("least", VT::number, "smallest scale", "0"), 0),
        within(attribute("most", VT::number, "largest scale"), tiny)},
       {},
       VT::none,
       true,
       "<scale least=\"0.4\" most=\"1.4\"/>"},
      {"Neighbourhood",
       "neighbourhood",
       "How far the plant acts on neighbours.",
       {required(
           within(attribute("radius", VT::length,
                            "of its field of neighbourhood at scale 1; without <neighbourhood>: twice the crown's"),
                  0))},
       {},
       VT::none,
       true,
       "<neighbourhood radius=\"9 m\"/>"},
      {"PlantInfluence",
       "influence",
       "What this plant does to a neighbour.",
       {required(attribute("on", VT::name, "the neighbour; * for all")),
        required(within(attribute("value", VT::number, "below 0 suppresses, above 0 furthers"), -10, 10))},
       {},
       VT::none,
       true,
       "<influence on=\"Quercus robur\" value=\"-0.4\"/>"},
      {"Property",
       "property",
       "How the plant responds to one condition: holds one of the Property elements.",
       {required(attribute("name", VT::name, "the name by which evaluators ask for it"))},
       {},
       VT::none,
       true,
       "<property name=\"MinMaxWater\"><MinMax min=\"0.2\" max=\"0.5\"/></property>"},
  };
}

}  // namespace silvasim::config
