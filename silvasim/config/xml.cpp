#include "silvasim/config/xml.h"

#include <tinyxml2.h>

#include <limits>

#include "silvasim/config/value.h"
#include "silvasim/config/xml_text.h"

namespace silvasim::config {

namespace {

struct Reader {
  const std::string& file;
  const Dialect& dialect;
  std::vector<base::Diagnostic>& errors;
  ColumnFinder columns;

  Node element(const tinyxml2::XMLElement& xml, const ElementRule& rule);
  void attributes(const tinyxml2::XMLElement& xml, Node& node);
  void content(const tinyxml2::XMLElement& xml, Node& node);
  void child_counts(Node& node);
  void error(base::Place place, std::string message) { errors.push_back({std::move(place), std::move(message)}); }
};

std::string tag_text(const std::string& tag) { return "<" + tag + ">"; }

Node Reader::element(const tinyxml2::XMLElement& xml, const ElementRule& rule) {
  Node node;
  node.rule = &rule;
  node.place = {file, xml.GetLineNum(), columns.element(xml.GetLineNum(), xml.Name())};
  attributes(xml, node);
  content(xml, node);
  child_counts(node);
  return node;
}

void Reader::attributes(const tinyxml2::XMLElement& xml, Node& node) {
  const auto& rules = node.rule->attributes;
  node.values.resize(rules.size());
  node.places.resize(rules.size());
  std::vector<std::string> known;
  for (const AttributeRule& rule : rules) known.push_back(rule.name);

  for (const auto* attribute = xml.FirstAttribute(); attribute; attribute = attribute->Next()) {
    const std::string name = attribute->Name();
    // Editors put these on the root to find the schema.
    if (name == "xmlns" || name.starts_with("xmlns:") || name.starts_with("xsi:") || name == "xml:lang") continue;
    const int line = attribute->GetLineNum();
    const base::Place place{file, line, columns.attribute(line, name, line == node.place.line ? node.place.column : 0)};
    std::size_t i = 0;
    while (i < rules.size() && rules[i].name != name) ++i;
    if (i == rules.size()) {
      error(place, tag_text(node.rule->tag) + " has no attribute \"" + name + "\"" + base::did_you_mean(name, known));
      continue;
    }
    const AttributeRule& rule = rules[i];
    ParsedValue parsed = parse_value(trimmed(attribute->Value()), rule.type, rule.choices, rule.least, rule.most);
    if (!parsed.problem.empty()) {
      error(place, tag_text(node.rule->tag) + " " + name + ": " + parsed.problem + "; expected " +
                       describe(rule.type, rule.choices, rule.least, rule.most));
    } else {
      node.values[i] = std::move(parsed.value);
    }
    node.places[i] = place;
  }

  for (std::size_t i = 0; i < rules.size(); ++i) {
    if (node.places[i].line > 0 && !std::holds_alternative<std::monostate>(node.values[i])) continue;
    if (rules[i].required && node.places[i].line == 0) {
      error(node.place, tag_text(node.rule->tag) + " needs the attribute \"" + rules[i].name + "\": " + rules[i].help);
    }
    // A wrong value is reported already; its default, or a harmless one, lets the rest be checked.
    const std::string& fallback = rules[i].fallback;
    if (!fallback.empty()) {
      node.values[i] = parse_value(fallback, rules[i].type, rules[i].choices, rules[i].least, rules[i].most).value;
    } else if (rules[i].required) {
      switch (rules[i].type) {
        case ValueType::boolean:
          node.values[i] = false;
          break;
        case ValueType::text:
        case ValueType::name:
        case ValueType::path:
          node.values[i] = std::string();
          break;
        case ValueType::choice:
          node.values[i] = rules[i].choices.front();
          break;
        default:
          node.values[i] = 0.0;
      }
    }
  }
}

void Reader::content(const tinyxml2::XMLElement& xml, Node& node) {
  std::vector<std::string> known;
  for (const ChildRule& child : node.rule->children) known.push_back(dialect.rule(child.type).tag);

  for (const auto* child = xml.FirstChild(); child; child = child->NextSibling()) {
    if (const auto* text = child->ToText()) {
      if (!node.rule->children.empty() || node.rule->text == ValueType::none) {
        const std::string stray = trimmed(text->Value());
        if (!stray.empty()) {
          error({file, text->GetLineNum(), 0},
                tag_text(node.rule->tag) + " takes no text, found \"" + stray.substr(0, 40) + "\"");
        }
      } else {
        node.text += text->Value();
      }
      continue;
    }
    const auto* below = child->ToElement();
    if (!below) continue;
    const ElementRule* rule = nullptr;
    for (const ChildRule& candidate : node.rule->children) {
      if (dialect.rule(candidate.type).tag == below->Name()) rule = &dialect.rule(candidate.type);
    }
    if (rule) {
      node.children.push_back(element(*below, *rule));
      continue;
    }
    const int line = below->GetLineNum();
    std::string message = tag_text(below->Name()) + " is unknown inside " + tag_text(node.rule->tag);
    const std::string hint = base::did_you_mean(below->Name(), known);
    if (!hint.empty()) {
      message += hint;
    } else if (known.empty()) {
      message += ", which takes no elements";
    } else if (known.size() <= 12) {
      message += "; known are ";
      for (std::size_t i = 0; i < known.size(); ++i) message += (i ? ", " : "") + tag_text(known[i]);
    }
    error({file, line, columns.element(line, below->Name())}, std::move(message));
  }

  node.text = trimmed(node.text);
  if (node.rule->text == ValueType::none) return;
  if (node.text.empty() && !node.rule->text_required) return;
  ParsedValue parsed = parse_value(node.text, node.rule->text, {}, -std::numeric_limits<double>::infinity(),
                                   std::numeric_limits<double>::infinity());
  if (!parsed.problem.empty()) {
    error(node.place, tag_text(node.rule->tag) + ": " + parsed.problem + "; expected " +
                          describe(node.rule->text, {}, -std::numeric_limits<double>::infinity(),
                                   std::numeric_limits<double>::infinity()));
  }
  node.text_value = std::move(parsed.value);
}

void Reader::child_counts(Node& node) {
  for (const ChildRule& rule : node.rule->children) {
    const auto found = node.all(rule.type);
    const std::string tag = tag_text(dialect.rule(rule.type).tag);
    if (static_cast<int>(found.size()) < rule.least) {
      error(node.place, tag_text(node.rule->tag) + " needs " +
                            (rule.least == 1 ? "a " : std::to_string(rule.least) + " of ") + tag +
                            (found.empty() ? "" : ", has only " + std::to_string(found.size())));
    }
    if (rule.most >= 0 && static_cast<int>(found.size()) > rule.most) {
      error(found[static_cast<std::size_t>(rule.most)]->place,
            tag_text(node.rule->tag) + " takes only " + (rule.most == 1 ? "one " : std::to_string(rule.most) + " of ") +
                tag);
    }
  }
}

std::string library_message(const tinyxml2::XMLDocument& document) {
  switch (document.ErrorID()) {
    case tinyxml2::XML_ERROR_EMPTY_DOCUMENT:
      return "the file has no XML in it";
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
      return "an element is not closed, or closed by another name";
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
      return "an attribute is malformed or stands twice";
    case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED:
      return "elements are nested too deep";
    case tinyxml2::XML_ERROR_PARSING_COMMENT:
      return "a comment is not closed";
    case tinyxml2::XML_ERROR_PARSING_CDATA:
      return "a CDATA section is not closed";
    case tinyxml2::XML_ERROR_PARSING_ELEMENT:
      return "an element is malformed";
    case tinyxml2::XML_ERROR_PARSING_TEXT:
      return "text outside of an element";
    case tinyxml2::XML_ERROR_PARSING_DECLARATION:
      return "the XML declaration is malformed or not at the start";
    default:
      return "not well-formed XML";
  }
}

}  // namespace

std::optional<Node> parse_xml(const std::string& text, const std::string& file, const Dialect& dialect,
                              const std::string& root, std::vector<base::Diagnostic>& errors) {
  if (text.size() > most_config_bytes) {
    errors.push_back({{file, 0, 0},
                      "the file has " + std::to_string(text.size()) + " bytes; a configuration has at most " +
                          std::to_string(most_config_bytes)});
    return std::nullopt;
  }
  if (auto problem = check_xml_text(text, file)) {
    errors.push_back(*problem);
    return std::nullopt;
  }
  tinyxml2::XMLDocument document;
  document.Parse(text.data(), text.size());
  if (document.Error()) {
    errors.push_back({{file, document.ErrorLineNum(), 0}, library_message(document)});
    return std::nullopt;
  }

  const ElementRule& rule = dialect.rule(root);
  const tinyxml2::XMLElement* first = document.RootElement();
  if (!first) {
    errors.push_back({{file, 1, 0}, "the file has no element; expected " + tag_text(rule.tag)});
    return std::nullopt;
  }
  if (first->NextSiblingElement()) {
    errors.push_back({{file, first->NextSiblingElement()->GetLineNum(), 0}, "a second root element; XML has one"});
    return std::nullopt;
  }
  for (const auto* node = document.FirstChild(); node; node = node->NextSibling()) {
    if (node->ToText() && !trimmed(node->Value()).empty()) {
      errors.push_back({{file, node->GetLineNum(), 0}, "text outside of the root element"});
      return std::nullopt;
    }
  }
  Reader reader{file, dialect, errors, ColumnFinder(text)};
  if (rule.tag != first->Name()) {
    errors.push_back({{file, first->GetLineNum(), reader.columns.element(first->GetLineNum(), first->Name())},
                      "the root element is " + tag_text(std::string(first->Name()).substr(0, 60)) + "; expected " +
                          tag_text(rule.tag)});
    return std::nullopt;
  }
  return reader.element(*first, rule);
}

}  // namespace silvasim::config
