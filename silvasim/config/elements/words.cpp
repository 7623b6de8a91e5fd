#include <utility>

#include "silvasim/config/elements/elements.h"

namespace silvasim::config {

AttributeRule attribute(std::string name, ValueType type, std::string help, std::string fallback) {
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

AttributeRule within(AttributeRule rule, double least, double most) {
  rule.least = least;
  rule.most = most;
  return rule;
}

AttributeRule choice(std::string name, std::vector<std::string> choices, std::string help, std::string fallback) {
  AttributeRule rule = attribute(std::move(name), ValueType::choice, std::move(help), std::move(fallback));
  rule.choices = std::move(choices);
  return rule;
}

}  // namespace silvasim::config
