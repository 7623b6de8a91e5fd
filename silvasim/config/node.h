// A checked XML element: known tag, known attributes, typed values, defaults filled in.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "silvasim/base/place.h"
#include "silvasim/config/rules.h"

namespace silvasim::config {

// monostate: absent. Numbers in base units; a choice is the chosen word.
using Value = std::variant<std::monostate, double, bool, std::string>;

struct Node {
  const ElementRule* rule = nullptr;  // in the dialect, which outlives the node
  base::Place place;
  std::vector<Value> values;        // one for each rule->attributes
  std::vector<base::Place> places;  // of the attributes; line 0 where the default was taken
  std::string text;                 // trimmed
  Value text_value;
  std::vector<Node> children;

  // Whether the rule has the attribute at all.
  bool knows(const std::string& attribute) const;

  // By attribute name, which must be in the rule.
  bool has(const std::string& attribute) const;
  bool given(const std::string& attribute) const;  // written by the user, not a default
  double number(const std::string& attribute) const;
  bool boolean(const std::string& attribute) const;
  const std::string& string(const std::string& attribute) const;
  const base::Place& place_of(const std::string& attribute) const;  // the element's where the attribute is absent

  // The first child of the type, or null; all of them.
  const Node* child(const std::string& type) const;
  std::vector<const Node*> all(const std::string& type) const;

 private:
  std::size_t index(const std::string& attribute) const;
};

}  // namespace silvasim::config
