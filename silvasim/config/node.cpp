#include "silvasim/config/node.h"

#include <algorithm>
#include <stdexcept>

namespace silvasim::config {

std::size_t Node::index(const std::string& attribute) const {
  for (std::size_t i = 0; i < rule->attributes.size(); ++i) {
    if (rule->attributes[i].name == attribute) return i;
  }
  throw std::logic_error("<" + rule->tag + "> has no attribute " + attribute + " in its table");
}

bool Node::knows(const std::string& attribute) const {
  return std::any_of(rule->attributes.begin(), rule->attributes.end(),
                     [&](const AttributeRule& known) { return known.name == attribute; });
}

bool Node::has(const std::string& attribute) const {
  return !std::holds_alternative<std::monostate>(values[index(attribute)]);
}

bool Node::given(const std::string& attribute) const { return places[index(attribute)].line > 0; }

double Node::number(const std::string& attribute) const { return std::get<double>(values[index(attribute)]); }

bool Node::boolean(const std::string& attribute) const { return std::get<bool>(values[index(attribute)]); }

const std::string& Node::string(const std::string& attribute) const {
  static const std::string absent;
  const Value& value = values[index(attribute)];
  return std::holds_alternative<std::monostate>(value) ? absent : std::get<std::string>(value);
}

const base::Place& Node::place_of(const std::string& attribute) const {
  const base::Place& written = places[index(attribute)];
  return written.line > 0 ? written : place;
}

const Node* Node::child(const std::string& type) const {
  for (const Node& child : children) {
    if (child.rule->type == type) return &child;
  }
  return nullptr;
}

std::vector<const Node*> Node::all(const std::string& type) const {
  std::vector<const Node*> found;
  for (const Node& child : children) {
    if (child.rule->type == type) found.push_back(&child);
  }
  return found;
}

}  // namespace silvasim::config
