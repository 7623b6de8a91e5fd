// The grammar of rules: <where>, <response> and the sources.
#include "silvasim/config/elements/elements.h"

#include "ghosttile/cover/rule_xml.h"
#include "silvasim/evaluators/evaluator.h"

namespace ghosttile::cover {

namespace config = silvasim::config;
using config::attribute;
using config::within;
using VT = config::ValueType;

namespace {

config::ElementRule source_rule(std::string type, std::string tag, std::string help,
                                std::vector<config::AttributeRule> attributes, std::string example) {
  return {std::move(type), std::move(tag), std::move(help),   std::move(attributes), {},
          VT::none,        true,           std::move(example)};
}

// Attributes of their own, then those of the choice of plants.
std::vector<config::AttributeRule> of_plants(std::vector<config::AttributeRule> own) {
  std::vector<config::AttributeRule> all = choice_attributes();
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

config::AttributeRule month() {
  return within(
      attribute("month", VT::number, "time of the year, 1 to 13: 10.5 is the middle of October; default: the scene's"),
      1, 13);
}

}  // namespace

std::vector<config::AttributeRule> choice_attributes() {
  return {
      attribute(
          "species", VT::text,
          "which plants: scientific names, genera, \"broadleaf\" or \"needles\", with commas between; default: all"),
      attribute("layer", VT::name, "only plants of this vegetation layer; default: all")};
}

std::vector<config::ElementRule> cover_rules() {
  std::vector<config::ElementRule> rules = {
      source_rule(
          "CrownCover", "crowncover",
          "How much of the place crowns cover, 0 to 1: 1 under a crown, falling to 0 at its edge.",
          of_plants(
              {within(attribute("reach", VT::length, "how far beyond the crown it falls to 0", "0 m"), 0, 100),
               within(attribute("rim", VT::fraction, "share of the crown's radius on which it falls", "0.25"), 0, 1)}),
          "<crowncover species=\"Fagus sylvatica, Quercus\" reach=\"1 m\"/>"),
      source_rule(
          "Litter", "litter",
          "How much of the place fallen leaves or needles cover, 0 to 1: crown cover times what the season leaves "
          "on the ground, by species.",
          of_plants(
              {within(attribute("reach", VT::length, "how far beyond the crown the wind carries them", "1 m"), 0, 100),
               within(attribute("rim", VT::fraction, "share of the crown's radius on which they thin out", "0.25"), 0,
                      1),
               month()}),
          "<litter species=\"broadleaf\" reach=\"2 m\" month=\"11\"/>"),
      source_rule("StemDistance", "stemdistance", "Metres to the axis of the nearest stem.",
                  of_plants({within(
                      attribute("most", VT::length, "looked for no farther; the value where none is nearer", "10 m"),
                      config::tiny, 100)}),
                  "<stemdistance layer=\"trees\" most=\"5 m\"/>"),
      source_rule(
          "StandDensity", "standdensity", "How densely plants stand around the place.",
          of_plants({within(attribute("radius", VT::length, "of the disc around the place", "15 m"), 0.5, 500),
                     config::choice("measure", {"stems", "basal-area"},
                                    "stems a hectare, or the area of their cross-sections in square metres a hectare",
                                    "stems")}),
          "<standdensity layer=\"trees\" radius=\"20 m\" measure=\"basal-area\"/>"),
      source_rule(
          "Light", "light", "Share of an overcast sky's light that crowns let down to the ground, 0 to 1.",
          of_plants({within(attribute("leafarea", VT::number,
                                      "square metres of leaves over a square metre below a crown in summer", "5"),
                            0, 30),
                     month()}),
          "<light/>"),
      source_rule("Elevation", "elevation", "The ground's height in metres above the sea.", {}, "<elevation/>"),
      source_rule("Slope", "slope", "The ground's slope in degrees.", {}, "<slope/>"),
      source_rule("Northness", "northness",
                  "cos(aspect) sin(slope): 1 steep and facing north, -1 steep and facing south.", {}, "<northness/>"),
      source_rule("Eastness", "eastness", "sin(aspect) sin(slope): 1 steep and facing east, -1 steep and facing west.",
                  {}, "<eastness/>"),
      source_rule("Month", "month", "The scene's time of the year, 1 to 13: 10.5 is the middle of October.", {},
                  "<month/>"),
      source_rule("Patches", "patches", "Smooth noise, 0 to 1 around 0.5: patches where nothing else makes any.",
                  {within(attribute("size", VT::length, "how wide they are", "3 m"), 0.1, 10000),
                   within(attribute("seed", VT::integer, "one number, one pattern", "0"), 0, 4294967295.0)},
                  "<patches size=\"2 m\" seed=\"3\"/>"),
      {"CoverDatafield",
       "datafield",
       "A data field of the ecosystem, by name, in its own unit.",
       {},
       {},
       VT::name,
       true,
       "<datafield>to_water</datafield>"},
  };
  std::vector<config::ChildRule> children;
  for (const config::ElementRule& rule : rules) children.push_back({rule.type, 0, 1});
  for (const std::string& type : silvasim::evaluators::dialect().properties) children.push_back({type, 0, 1});
  rules.push_back({"Response",
                   "response",
                   "One source and the Property that answers to it; a source that is a share already needs none.",
                   {},
                   children,
                   VT::none,
                   true,
                   "<response><slope/><Trapezoid a=\"10\" b=\"25\" c=\"60\" d=\"90\"/></response>"});
  rules.push_back(
      {"Where",
       "where",
       "A rule: how much of a detail there is at a place, 0 to 1, by what the place is like.",
       {config::choice("combine", {"product", "least", "greatest"}, "what is made of the answers", "product")},
       {{"Response"}, {"Where"}},
       VT::none,
       true,
       "<where><response><light/><Table><point x=\"0.2\" y=\"0\"/><point x=\"0.6\" "
       "y=\"1\"/></Table></response></where>"});
  return rules;
}

std::vector<config::ElementRule> property_rules() {
  const config::Dialect& dialect = silvasim::evaluators::dialect();
  std::vector<config::ElementRule> rules;
  for (const std::string& type : dialect.properties) rules.push_back(dialect.rule(type));
  for (const char* type : {"ClassValue", "TablePoint"}) rules.push_back(dialect.rule(type));
  return rules;
}

}  // namespace ghosttile::cover
