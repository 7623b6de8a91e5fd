// Joins the fixed elements (elements/) with the families of Properties and Evaluators, which bring tables of their own.
#include <stdexcept>
#include <utility>

#include "silvasim/config/elements/elements.h"

namespace silvasim::config {

using VT = ValueType;

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
  dialect.program = "silvasim";
  dialect.about = "the ecosystem file and the plants file";
  dialect.roots = {"Ecosystem", "Plants"};
  Chapter responses_to{"Properties", dialect.properties};
  responses_to.types.insert(responses_to.types.end(), {"ClassValue", "TablePoint"});
  dialect.chapters = {
      {"The ecosystem file", {"Ecosystem"}},
      {"The plants file", {"Plants", "Plant", "Model", "Scale", "Neighbourhood", "PlantInfluence", "Property"}},
      std::move(responses_to),
      {"Evaluators", dialect.evaluators}};
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
