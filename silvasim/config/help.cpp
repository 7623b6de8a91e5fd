#include "silvasim/config/help.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "silvasim/config/value.h"

namespace silvasim::config {

namespace {

std::string first_sentence(const std::string& text) {
  const std::size_t end = text.find(". ");
  return end == std::string::npos ? text : text.substr(0, end + 1);
}

std::string attribute_line(const AttributeRule& rule) {
  std::string line = rule.help + " (" + describe(rule.type, rule.choices, rule.least, rule.most);
  if (rule.required) line += "; required";
  if (!rule.fallback.empty()) line += "; default " + rule.fallback;
  return line + ")";
}

std::string inside(const ElementRule& rule, const Dialect& dialect) {
  if (rule.text != ValueType::none)
    return "Text: " +
           describe(rule.text, {}, -std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity());
  std::string text;
  for (const ChildRule& child : rule.children) {
    text += (text.empty() ? "Inside: <" : ", <") + dialect.rule(child.type).tag + ">";
    if (child.least > 0) text += " (needed)";
  }
  return text;
}

// Rows of the manual and the overview: what belongs together, in the order in which a reader needs it.
std::vector<std::pair<std::string, std::vector<const ElementRule*>>> chapters(const Dialect& dialect) {
  std::vector<std::pair<std::string, std::vector<const ElementRule*>>> all;
  for (const Chapter& chapter : dialect.chapters) all.push_back({chapter.title, {}});
  const auto chapter_of = [&](const std::string& type) {
    for (std::size_t c = 0; c < dialect.chapters.size(); ++c) {
      const std::vector<std::string>& types = dialect.chapters[c].types;
      if (std::find(types.begin(), types.end(), type) != types.end()) return c;
    }
    return std::size_t{0};
  };
  for (const std::string& root : dialect.roots) all[chapter_of(root)].second.push_back(&dialect.rule(root));
  for (const ElementRule& rule : dialect.rules) {
    if (std::find(dialect.roots.begin(), dialect.roots.end(), rule.type) == dialect.roots.end())
      all[chapter_of(rule.type)].second.push_back(&rule);
  }
  return all;
}

}  // namespace

std::string help_overview(const Dialect& dialect) {
  std::string text;
  for (const auto& [title, rules] : chapters(dialect)) {
    text += (text.empty() ? "" : "\n") + title + "\n";
    for (const ElementRule* rule : rules) {
      std::string name = "  <" + rule->tag + ">";
      name.resize(std::max<std::size_t>(name.size() + 1, 24), ' ');
      text += name + first_sentence(rule->help) + "\n";
    }
  }
  return text + "\n" + dialect.program + " help ELEMENT tells its attributes, what stands inside, and an example.\n";
}

std::string help_element(const Dialect& dialect, const std::string& name) {
  std::string text;
  for (const ElementRule& rule : dialect.rules) {
    if (rule.tag != name && rule.type != name) continue;
    text += (text.empty() ? "" : "\n") + ("<" + rule.tag + ">  " + rule.help + "\n");
    for (const AttributeRule& attribute : rule.attributes)
      text += "  " + attribute.name + ": " + attribute_line(attribute) + "\n";
    const std::string content = inside(rule, dialect);
    if (!content.empty()) text += "  " + content + "\n";
    if (!rule.example.empty()) text += "  Example: " + rule.example + "\n";
  }
  return text;
}

std::string help_manual(const Dialect& dialect) {
  std::string text = "# The dialect" + (dialect.program == "silvasim" ? std::string() : " of " + dialect.program) +
                     "\n\nEvery element of " + dialect.about + ". This page is written by `" + dialect.program +
                     " help --manual` from the tables that the parser works by.\n";
  for (const auto& [title, rules] : chapters(dialect)) {
    text += "\n## " + title + "\n";
    for (const ElementRule* rule : rules) {
      text += "\n### `<" + rule->tag + ">`" + (rule->tag == rule->type ? "" : " (" + rule->type + ")") + "\n\n" +
              rule->help + "\n";
      const std::string content = inside(*rule, dialect);
      if (!content.empty()) text += "\n" + content + "\n";
      if (!rule->attributes.empty()) text += "\n| attribute | meaning |\n|---|---|\n";
      for (const AttributeRule& attribute : rule->attributes) {
        text += "| `" + attribute.name + "` | " + attribute_line(attribute) + " |\n";
      }
      if (!rule->example.empty()) text += "\n```xml\n" + rule->example + "\n```\n";
    }
  }
  return text;
}

std::vector<std::string> element_names(const Dialect& dialect) {
  std::vector<std::string> names;
  for (const ElementRule& rule : dialect.rules) {
    if (std::find(names.begin(), names.end(), rule.tag) == names.end()) names.push_back(rule.tag);
  }
  return names;
}

}  // namespace silvasim::config
