#include "silvasim/config/xml.h"

#include <tinyxml2.h>

#include <limits>
#include <string_view>

#include "silvasim/base/words.h"
#include "silvasim/config/value.h"
#include "silvasim/config/xml_text.h"

namespace silvasim::config {

namespace {

struct Reader {
  const std::string& file;
  const Dialect& dialect;
  std::vector<base::Diagnostic>& errors;
  const XmlPlaces& places;

  Node element(const tinyxml2::XMLElement& xml, const ElementRule& rule);
  void attributes(const tinyxml2::XMLElement& xml, Node& node);
  void content(const tinyxml2::XMLElement& xml, Node& node);
  void child_counts(Node& node);
  const XmlPlaces::Element& mark(const tinyxml2::XMLElement& xml) const {
    return *static_cast<const XmlPlaces::Element*>(xml.GetUserData());
  }
  base::Place at(TextPlace place) const { return {file, place.line, place.column}; }
  bool full() const { return errors.size() > base::most_diagnostics; }
  void error(base::Place place, std::string message) { base::add(errors, std::move(place), std::move(message)); }
};

// The library keeps no columns: gives each element its place, in the order of the document. Returns whether the library
// and the scanner have seen the same elements, which they always should.
bool put_places(tinyxml2::XMLElement* root, XmlPlaces& places) {
  std::size_t next = 0;
  for (tinyxml2::XMLNode* node = root; node;) {
    if (node->ToElement()) {
      if (next == places.elements.size()) return false;
      node->SetUserData(&places.elements[next++]);
    }
    if (node->FirstChild()) {
      node = node->FirstChild();
      continue;
    }
    while (node && node != root && !node->NextSibling()) node = node->Parent();
    node = node && node != root ? node->NextSibling() : nullptr;
  }
  return next == places.elements.size();
}

std::string tag_text(const std::string& tag) { return "<" + tag + ">"; }

Node Reader::element(const tinyxml2::XMLElement& xml, const ElementRule& rule) {
  Node node;
  node.rule = &rule;
  node.place = at(mark(xml).at);
  attributes(xml, node);
  content(xml, node);
  child_counts(node);
  return node;
}

// Editors find the schema by two attributes of the root.
bool names_the_schema(const tinyxml2::XMLElement& xml, const tinyxml2::XMLAttribute& attribute) {
  if (!xml.Parent() || !xml.Parent()->ToDocument()) return false;
  const char* const instance = xml.Attribute("xmlns:xsi");
  if (!instance || std::string_view(instance) != "http://www.w3.org/2001/XMLSchema-instance") return false;
  const std::string_view name = attribute.Name();
  return name == "xmlns:xsi" || name == "xsi:noNamespaceSchemaLocation";
}

void Reader::attributes(const tinyxml2::XMLElement& xml, Node& node) {
  const auto& rules = node.rule->attributes;
  node.values.resize(rules.size());
  node.places.resize(rules.size());
  std::vector<std::string> known;
  for (const AttributeRule& rule : rules) known.push_back(rule.name);

  std::size_t number = mark(xml).first_attribute;
  for (const auto* attribute = xml.FirstAttribute(); attribute; attribute = attribute->Next()) {
    const std::string name = attribute->Name();
    const base::Place place = at(places.attributes.at(number++));
    if (names_the_schema(xml, *attribute)) continue;
    std::size_t i = 0;
    while (i < rules.size() && rules[i].name != name) ++i;
    if (i == rules.size()) {
      if (full()) continue;
      error(place, tag_text(node.rule->tag) + " has no attribute \"" + base::shortened(name, 60) + "\"" +
                       base::did_you_mean(name, known));
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
        if (!stray.empty() || text->CData()) {
          error({file, text->GetLineNum(), 0},
                tag_text(node.rule->tag) + " takes no text, found \"" + base::shortened(stray, 40) + "\"");
        }
      } else {
        node.text += text->Value();
      }
      continue;
    }
    const auto* below = child->ToElement();
    if (!below) continue;
    const ElementRule* rule = nullptr;
    for (std::size_t i = 0; i < known.size(); ++i) {
      if (known[i] == below->Name()) rule = &dialect.rule(node.rule->children[i].type);
    }
    if (rule) {
      node.children.push_back(element(*below, *rule));
      continue;
    }
    if (full()) continue;
    std::string message =
        tag_text(base::shortened(below->Name(), 60)) + " is unknown inside " + tag_text(node.rule->tag);
    const std::string hint = base::did_you_mean(below->Name(), known);
    if (!hint.empty()) {
      message += hint;
    } else if (known.empty()) {
      message += ", which takes no elements";
    } else if (known.size() <= 12) {
      message += "; known are ";
      for (std::size_t i = 0; i < known.size(); ++i) message += (i ? ", " : "") + tag_text(known[i]);
    }
    error(at(mark(*below).at), std::move(message));
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

}  // namespace

std::optional<Node> parse_xml(const std::string& text, const std::string& file, const Dialect& dialect,
                              const std::string& root, std::vector<base::Diagnostic>& errors) {
  if (text.size() > most_config_bytes) {
    errors.push_back({{file, 0, 0},
                      "the file has " + std::to_string(text.size()) + " bytes; a configuration has at most " +
                          std::to_string(most_config_bytes)});
    return std::nullopt;
  }
  XmlPlaces places;
  try {
    places = scan_xml(text, file);
  } catch (const base::ConfigError& error) {
    errors.insert(errors.end(), error.diagnostics().begin(), error.diagnostics().end());
    return std::nullopt;
  }
  tinyxml2::XMLDocument document;
  document.Parse(text.data(), text.size());
  if (document.ErrorID() == tinyxml2::XML_ERROR_EMPTY_DOCUMENT) {
    errors.push_back({{file, 0, 0}, "the file has no XML in it"});
    return std::nullopt;
  }
  if (document.ErrorID() == tinyxml2::XML_ERROR_PARSING_DECLARATION) {
    errors.push_back(
        {{file, document.ErrorLineNum(), 0}, "an instruction (<?...?>) after the first element or comment"});
    return std::nullopt;
  }

  const ElementRule& rule = dialect.rule(root);
  if (!document.Error() && !document.RootElement()) {
    errors.push_back({{file, 1, 0}, "the file has no element; expected " + tag_text(rule.tag)});
    return std::nullopt;
  }
  if (document.Error() || !put_places(document.RootElement(), places)) {
    errors.push_back({{file, document.ErrorLineNum(), 0}, "not well-formed XML"});
    return std::nullopt;
  }
  const tinyxml2::XMLElement* first = document.RootElement();
  Reader reader{file, dialect, errors, places};
  if (rule.tag != first->Name()) {
    errors.push_back(
        {reader.at(places.elements.front().at),
         "the root element is " + tag_text(base::shortened(first->Name(), 60)) + "; expected " + tag_text(rule.tag)});
    return std::nullopt;
  }
  return reader.element(*first, rule);
}

}  // namespace silvasim::config
