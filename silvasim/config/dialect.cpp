// The fixed part of the dialect: everything but the families of Properties and Evaluators, which bring their own tables.
#include <stdexcept>
#include <utility>

#include "silvasim/config/rules.h"

namespace silvasim::config {

namespace {

using VT = ValueType;

constexpr double tiny = 1e-9;  // the least of what must be positive

AttributeRule attribute(std::string name, VT type, std::string help, std::string fallback = "") {
  AttributeRule rule;
  rule.name = std::move(name);
  rule.type = type;
  rule.help = std::move(help);
  rule.fallback = std::move(fallback);
  return rule;
}

AttributeRule required(AttributeRule rule) {
  rule.required = true;
  return rule;
}

AttributeRule within(AttributeRule rule, double least, double most = std::numeric_limits<double>::infinity()) {
  rule.least = least;
  rule.most = most;
  return rule;
}

AttributeRule choice(std::string name, std::vector<std::string> choices, std::string help, std::string fallback = "") {
  AttributeRule rule = attribute(std::move(name), VT::choice, std::move(help), std::move(fallback));
  rule.choices = std::move(choices);
  return rule;
}

// What every data field says about missing data.
std::vector<AttributeRule> with_no_data(std::vector<AttributeRule> attributes) {
  attributes.push_back(choice(
      "nodata", {"exclude", "ignore", "fill"},
      "where the field has no data: nothing grows, its evaluators say 1, or it has the value of fill", "exclude"));
  attributes.push_back(attribute("fill", VT::number, "the value where the field has no data, with nodata=\"fill\""));
  return attributes;
}

std::vector<ElementRule> scene_rules() {
  return {
      {"Include",
       "include",
       "Takes in the elements of another file with the same root.",
       {},
       {},
       VT::path,
       true,
       "<include>common.xml</include>"},
      {"Scene",
       "scene",
       "The piece of land that is planted, and its coordinates.",
       {attribute(
           "crs", VT::name,
           "coordinate system: EPSG code, WKT or PROJ text, or \"local\" for metres without a place on the earth; "
           "default: the terrain's, or its UTM zone where the terrain is in degrees")},
       {{"Extent", 0, 1}, {"Size", 0, 1}},
       VT::none,
       true,
       "<scene crs=\"EPSG:32632\"><extent west=\"570000\" south=\"5725000\" east=\"574000\" "
       "north=\"5728000\"/></scene>"},
      {"Extent",
       "extent",
       "The scene's box, in the scene's coordinates or in degrees.",
       {required(attribute("west", VT::number, "least easting or longitude")),
        required(attribute("south", VT::number, "least northing or latitude")),
        required(attribute("east", VT::number, "greatest easting or longitude")),
        required(attribute("north", VT::number, "greatest northing or latitude")),
        attribute("degrees", VT::boolean, "the four numbers are degrees of WGS 84", "false")},
       {},
       VT::none,
       true,
       "<extent west=\"-121.9\" south=\"46.7\" east=\"-121.6\" north=\"46.9\" degrees=\"true\"/>"},
      {"Size",
       "size",
       "The scene's size: about the terrain's middle, or a local box from (0, 0).",
       {required(within(attribute("width", VT::length, "from west to east"), tiny)),
        required(within(attribute("height", VT::length, "from south to north"), tiny))},
       {},
       VT::none,
       true,
       "<size width=\"3 km\" height=\"3 km\"/>"},
  };
}

std::vector<ElementRule> field_rules() {
  return {
      {"Datafield",
       "datafield",
       "A raster that describes the place: any format, coordinate system and resolution. An image without georeference "
       "is "
       "stretched over the scene and read as 0 to 1.",
       with_no_data(
           {required(attribute("name", VT::name, "the name by which evaluators ask for it")),
            attribute("terrain", VT::boolean, "it is the ground's height in metres", "false"),
            choice("kind", {"value", "class"}, "a quantity (read between its cells) or codes of classes (nearest cell)",
                   "value"),
            within(attribute("band", VT::integer, "which band of the file", "1"), 1, 65535),
            attribute("crs", VT::name, "its coordinate system where the file does not say it, or says it wrongly"),
            attribute("nodata-value", VT::number, "a value that means no data, besides what the file says"),
            attribute("scale", VT::number, "value = raw * scale + offset"),
            attribute("offset", VT::number, "value = raw * scale + offset")}),
       {},
       VT::path,
       true,
       "<datafield name=\"elevation\" terrain=\"true\">dem.tif</datafield>"},
      {"Vectorfield",
       "vectorfield",
       "Polygons, lines or points that describe the place, turned into a field.",
       with_no_data(
           {required(attribute("name", VT::name, "the name by which evaluators ask for it")),
            choice("measure", {"inside", "attribute", "distance"},
                   "1 inside and 0 outside, the value of an attribute, or metres to the nearest feature", "inside"),
            attribute("attribute", VT::name, "the attribute whose number is taken, with measure=\"attribute\""),
            choice("kind", {"value", "class"}, "a quantity or codes of classes", "value"),
            attribute("layer", VT::name, "which layer of the file; default: the first"),
            attribute("where", VT::text, "only features for which this is true, as in SQL: FTYPE = 'STREAM'"),
            attribute("crs", VT::name, "its coordinate system where the file does not say it, or says it wrongly"),
            within(attribute("resolution", VT::length,
                             "cell size of the field; default: a 2000th of the scene's longer side, 1 m at least"),
                   tiny)}),
       {},
       VT::path,
       true,
       "<vectorfield name=\"to_stream\" measure=\"distance\" where=\"FTYPE = 'STREAM'\">streams.shp</vectorfield>"},
      {"Derivedfield",
       "derivedfield",
       "A field computed from the terrain.",
       with_no_data(
           {required(attribute("name", VT::name, "the name by which evaluators ask for it")),
            required(
                choice("measure",
                       {"slope", "aspect", "northness", "eastness", "curvature", "tpi", "tri", "wetness", "hillshade"},
                       "slope and aspect in degrees; northness and eastness from -1 to 1; curvature in 1/m; "
                       "topographic position (tpi) and ruggedness (tri) in metres; wetness index; hillshade 0 to 1")),
            attribute("of", VT::name, "the field it is derived from; default: the terrain"),
            within(attribute("radius", VT::length, "of the disc for tpi; default: the eight neighbours"), tiny)}),
       {},
       VT::none,
       true,
       "<derivedfield name=\"slope\" measure=\"slope\"/>"},
  };
}

std::vector<ElementRule> layer_rules() {
  return {
      {"Tiles",
       "tiles",
       "The Wang tiles and the sites on them where plants may stand.",
       {within(attribute("side", VT::length, "a tile's side, more than 8 times the largest radius", "200 m"), tiny),
        within(attribute("colours", VT::integer,
                         "edge colours in each direction; 3 and 2 variants: the paper's 18 tiles", "3"),
               3, 64),
        within(attribute("variants", VT::integer,
                         "tiles for each pair of northern and western colour, at most colours - 1", "2"),
               1, 63),
        choice("mode", {"paper", "seamless"},
               "paper: discs may overlap at tile corners, where the weaker plant gives way; seamless: no overlap, but "
               "the corner repeats",
               "paper"),
        within(attribute("coverage", VT::fraction, "share of the ground under the sites' discs, at most 0.6", "0.5"),
               0.001, 0.6)},
       {{"Radii", 0, 1}},
       VT::none,
       true,
       "<tiles side=\"100 m\" mode=\"paper\"><radii least=\"2 m\" most=\"6 m\"/></tiles>"},
      {"Radii",
       "radii",
       "How large the sites are: the crown radii of the plants that will stand there.",
       {required(within(attribute("least", VT::length, "smallest radius"), tiny)),
        required(within(attribute("most", VT::length, "largest radius"), tiny)),
        choice("distribution", {"uniform", "normal", "lognormal"}, "of the radii between least and most", "uniform"),
        within(attribute("mean", VT::length,
                         "normal, lognormal: mean before cutting at least and most; default: the middle"),
               tiny),
        within(attribute("deviation", VT::length,
                         "normal, lognormal: standard deviation before cutting; default: a sixth of the range"),
               tiny)},
       {},
       VT::none,
       true,
       "<radii least=\"2 m\" most=\"6 m\" distribution=\"lognormal\" mean=\"3 m\" deviation=\"1 m\"/>"},
      {"Pipeline",
       "pipeline",
       "The evaluators, in the order in which they act on each site and plant.",
       {choice("combine", {"product", "length"}, "how the results are joined; groups inside may differ", "product")},
       {},
       VT::none,
       true,
       "<pipeline><RadiusEvaluator/></pipeline>"},
      {"Product", "product", "A group of evaluators whose results are multiplied.", {}, {}, VT::none, true, ""},
      {"Length",
       "length",
       "A group of evaluators whose results are the components of a vector; its length, divided by the square root of "
       "their "
       "number, is the group's result. Milder than a product: one zero does not erase a plant.",
       {},
       {},
       VT::none,
       true,
       ""},
      {"Establishment",
       "establishment",
       "Which plant a site takes, and whether it comes up.",
       {choice("selection", {"most-likely", "weighted"}, "the plant of highest probability, or a draw in proportion",
               "most-likely"),
        choice("chance", {"stochastic", "certain"},
               "the plant stands with its probability, so that stands thin out, or always", "stochastic")},
       {},
       VT::none,
       true,
       "<establishment selection=\"most-likely\" chance=\"stochastic\"/>"},
      {"Neighbourhoods",
       "neighbourhoods",
       "How plants further or suppress their neighbours (field of neighbourhood).",
       {within(attribute("cell", VT::length, "side of a grid cell; default: from the density of the sites"), tiny),
        within(attribute("passes", VT::integer, "how often the neighbours are weighed, at most", "2"), 1, 100),
        within(attribute("fmin", VT::fraction, "strength of the field at its rim, above 0", "0.1"), 1e-6, 1)},
       {{"Influence"}},
       VT::none,
       true,
       "<neighbourhoods passes=\"2\"><influence from=\"Fagus sylvatica\" on=\"*\" value=\"-0.4\"/></neighbourhoods>"},
      {"Influence",
       "influence",
       "What a plant does to a neighbour: its probability is multiplied by 1 + value * field, where the field is 1 at "
       "the stem.",
       {required(attribute("from", VT::name, "the plant that acts; * for all")),
        required(attribute("on", VT::name, "the neighbour; * for all")),
        required(within(attribute("value", VT::number, "below 0 suppresses, above 0 furthers"), -10, 10))},
       {},
       VT::none,
       true,
       "<influence from=\"Fagus sylvatica\" on=\"Quercus robur\" value=\"-0.4\"/>"},
      {"Corners",
       "corners",
       "How overlaps at the tiles' corners are solved.",
       {choice("solver", {"optimal", "paper"}, "keep the most probability times radius, or the paper's heuristic",
               "optimal")},
       {},
       VT::none,
       true,
       "<corners solver=\"optimal\"/>"},
      {"DatafieldReference", "datafield", "The data field that is looked up, by name.", {}, {}, VT::name, true, ""},
      {"PropertyReference", "property", "The plants' property that answers, by name.", {}, {}, VT::name, true, ""},
      {"PlantReference",
       "plant",
       "Limits the evaluator to this plant (and others so named).",
       {},
       {},
       VT::name,
       true,
       ""},
  };
}

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
       {required(within(
           attribute("radius", VT::length, "of its field of neighbourhood at scale 1; default: twice the crown's"),
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

}  // namespace

const ElementRule& Dialect::rule(const std::string& type) const {
  for (const ElementRule& rule : rules) {
    if (rule.type == type) return rule;
  }
  throw std::logic_error("the dialect has no element type " + type);
}

Dialect make_dialect(std::vector<ElementRule> properties, std::vector<ElementRule> evaluators) {
  Dialect dialect;
  for (const auto& family : {scene_rules(), field_rules(), layer_rules(), plant_rules()}) {
    dialect.rules.insert(dialect.rules.end(), family.begin(), family.end());
  }

  // Evaluators and their groups may stand in the pipeline, in each other, and (as in the paper) right in the ecosystem.
  std::vector<ChildRule> steps = {{"Product"}, {"Length"}};
  for (const ElementRule& rule : evaluators) {
    dialect.evaluators.push_back(rule.type);
    steps.push_back({rule.type});
  }
  std::vector<ChildRule> layer = {
      {"Tiles", 0, 1}, {"Pipeline", 0, 1}, {"Establishment", 0, 1}, {"Neighbourhoods", 0, 1}, {"Corners", 0, 1}};
  layer.insert(layer.end(), steps.begin(), steps.end());

  std::vector<ChildRule> ecosystem = {{"Include"},     {"Scene", 0, 1},  {"Datafield"},
                                      {"Vectorfield"}, {"Derivedfield"}, {"Layer"}};
  ecosystem.insert(ecosystem.end(), layer.begin(), layer.end());

  AttributeRule seed =
      attribute("seed", VT::integer, "the number that decides every draw; the same seed gives the same plants", "1");
  dialect.rules.push_back({"Ecosystem",
                           "ecosystem",
                           "The place: its frame, its data fields, its tiles, and how plants are evaluated.",
                           {attribute("name", VT::text, "title of maps and reports; default: the file's name"),
                            attribute("plants", VT::path, "the plants file; default: plants.xml beside this file"),
                            within(seed, 0, 9007199254740991.0)},
                           ecosystem,
                           VT::none,
                           true,
                           ""});
  dialect.rules.push_back({"Layer",
                           "layer",
                           "A vegetation layer (trees, shrubs, herbs) with its own tiles and plants.",
                           {required(attribute("name", VT::name, "by which plants say where they grow"))},
                           layer,
                           VT::none,
                           true,
                           "<layer name=\"shrubs\">...</layer>"});
  dialect.rules.push_back(
      {"Plants", "plants", "The species of the scene.", {}, {{"Include"}, {"Plant"}}, VT::none, true, ""});

  std::vector<ChildRule> responses;
  for (const ElementRule& rule : properties) {
    dialect.properties.push_back(rule.type);
    responses.push_back({rule.type, 0, 1});
  }
  for (ElementRule& rule : dialect.rules) {
    if (rule.type == "Pipeline" || rule.type == "Product" || rule.type == "Length") rule.children = steps;
    if (rule.type == "Property") rule.children = responses;
  }
  dialect.rules.insert(dialect.rules.end(), properties.begin(), properties.end());
  dialect.rules.insert(dialect.rules.end(), evaluators.begin(), evaluators.end());
  dialect.rules.push_back({"ClassValue",
                           "class",
                           "One class and its value.",
                           {required(attribute("code", VT::number, "the code in the data field")),
                            required(attribute("value", VT::fraction, "the plant's probability in it"))},
                           {},
                           VT::none,
                           true,
                           "<class code=\"5\" value=\"0.8\"/>"});
  dialect.rules.push_back({"TablePoint",
                           "point",
                           "One point of a piecewise linear response.",
                           {required(attribute("x", VT::number, "value of the data field")),
                            required(attribute("y", VT::fraction, "the plant's probability there"))},
                           {},
                           VT::none,
                           true,
                           "<point x=\"400\" y=\"1\"/>"});
  return dialect;
}

ElementRule evaluator_rule(std::string tag, std::string help, std::vector<AttributeRule> attributes,
                           EvaluatorNeeds needs, std::string example) {
  ElementRule rule;
  rule.type = tag;
  rule.tag = std::move(tag);
  rule.help = std::move(help);
  rule.example = std::move(example);
  rule.attributes = std::move(attributes);
  rule.attributes.push_back(attribute("lethal", VT::boolean, "a result of 0 removes the plant from the site for good",
                                      needs.lethal_by_default ? "true" : "false"));
  rule.attributes.push_back(
      within(attribute("floor", VT::fraction,
                       "the least result in a product when not lethal, so that one bad factor alone "
                       "cannot erase a plant",
                       "0.01"),
             0, 1));
  if (needs.datafield) rule.children.push_back({"DatafieldReference", 1, 1});
  if (needs.property) rule.children.push_back({"PropertyReference", needs.property_optional ? 0 : 1, 1});
  rule.children.push_back({"PlantReference"});
  return rule;
}

}  // namespace silvasim::config
