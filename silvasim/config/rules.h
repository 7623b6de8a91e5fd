// The grammar of the XML dialect as data. One table drives the parser, its messages, the XSD and the help, so that they
// cannot disagree.
//
// Children come in any order. Text content and children exclude each other.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace silvasim::config {

enum class ValueType {
  none,    // no text content
  text,    // anything
  name,    // not empty
  path,    // a file, relative to the XML file
  number,  // a plain number in the data field's own unit
  integer,
  boolean,   // true | false
  fraction,  // 0 to 1, or a percentage: 0.25, 25 %
  length,    // metres, or with unit: 200 m, 0.2 km, 30 cm, 100 ft
  angle,     // degrees, with or without the unit: 55, 55 deg
  duration,  // seconds, or with unit: 12 s, 2 min, 400 ms
  colour,    // #rrggbb
  choice,    // one of `choices`
};

struct AttributeRule {
  std::string name;
  ValueType type = ValueType::text;
  std::string help;
  bool required = false;
  std::string fallback;              // as the user would write it; "" = absent where not required
  std::vector<std::string> choices;  // ValueType::choice
  double least = -std::numeric_limits<double>::infinity();  // inclusive, in the base unit
  double most = std::numeric_limits<double>::infinity();
};

struct ChildRule {
  std::string type;  // ElementRule::type
  int least = 0;
  int most = -1;  // -1: any number
};

struct ElementRule {
  std::string type;  // unique in the dialect
  std::string tag;   // what stands in the XML; several types may share a tag in different places
  std::string help;  // first sentence: what it is
  std::vector<AttributeRule> attributes;
  std::vector<ChildRule> children;
  ValueType text = ValueType::none;
  bool text_required = true;
  std::string example;  // XML, for the help
};

// What the help and the manual put together.
struct Chapter {
  std::string title;
  std::vector<std::string> types;  // of the dialect's rules; the first chapter has all that stand in none
};

// The whole grammar. `properties` and `evaluators` are the types of those families, in the order of their tables.
struct Dialect {
  std::string program;             // whose files they are: "silvasim"
  std::string about;               // "the ecosystem file and the plants file"
  std::vector<std::string> roots;  // types that a file may begin with; each comes first in its chapter
  std::vector<Chapter> chapters;   // one at least
  std::vector<ElementRule> rules;
  std::vector<std::string> properties;
  std::vector<std::string> evaluators;

  const ElementRule& rule(const std::string& type) const;  // the type must exist
};

// Joins the fixed part of the dialect with the families of Properties and Evaluators.
Dialect make_dialect(std::vector<ElementRule> properties, std::vector<ElementRule> evaluators);

// An Evaluator's rule with what all of them share: lethal, floor, `<datafield>`, `<property>`, `<plant>`.
struct EvaluatorNeeds {
  bool datafield = true;
  bool property = true;
  bool property_optional = false;
  bool lethal_by_default = false;
};
ElementRule evaluator_rule(std::string tag, std::string help, std::vector<AttributeRule> attributes,
                           EvaluatorNeeds needs, std::string example);

}  // namespace silvasim::config
