#include "silvasim/config/schema.h"

#include <cmath>

#include "silvasim/config/value.h"

namespace silvasim::config {

namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string documentation(const std::string& help, const std::string& indent) {
  return indent + "<xs:annotation><xs:documentation>" + escaped(help) + "</xs:documentation></xs:annotation>\n";
}

const char* simple_type(ValueType type) {
  switch (type) {
    case ValueType::number:
      return "NumberValue";
    case ValueType::integer:
      return "WholeValue";
    case ValueType::boolean:
      return "xs:boolean";
    case ValueType::fraction:
      return "ShareValue";
    case ValueType::length:
      return "LengthValue";
    case ValueType::colour:
      return "ColourValue";
    case ValueType::name:
    case ValueType::path:
      return "TextValue";
    default:
      return "xs:string";
  }
}

std::string attribute(const AttributeRule& rule, const std::string& indent) {
  std::string out = indent + "<xs:attribute name=\"" + rule.name + "\"";
  if (rule.required) out += " use=\"required\"";
  if (!rule.fallback.empty()) out += " default=\"" + escaped(rule.fallback) + "\"";
  if (rule.type != ValueType::choice) {
    out += " type=\"" + std::string(simple_type(rule.type)) + "\">\n" + documentation(rule.help, indent + "  ");
  } else {
    out += ">\n" + documentation(rule.help, indent + "  ") + indent +
           "  <xs:simpleType><xs:restriction base=\"xs:token\">";
    for (const std::string& choice : rule.choices) out += "<xs:enumeration value=\"" + escaped(choice) + "\"/>";
    out += "</xs:restriction></xs:simpleType>\n";
  }
  return out + indent + "</xs:attribute>\n";
}

std::string complex_type(const ElementRule& rule, const Dialect& dialect) {
  std::string out = "  <xs:complexType name=\"" + rule.type + "\">\n" + documentation(rule.help, "    ");
  std::string indent = "    ";
  if (rule.text != ValueType::none) {
    const char* base = rule.text_required ? simple_type(rule.text) : "xs:string";
    out += "    <xs:simpleContent><xs:extension base=\"" + std::string(base) + "\">\n";
    indent = "      ";
  } else if (rule.children.empty()) {
    // Without content, but a formatter may put a blank or a new line there.
    out += "    <xs:simpleContent><xs:extension base=\"NoValue\">\n";
    indent = "      ";
  } else {
    out += "    <xs:choice minOccurs=\"0\" maxOccurs=\"unbounded\">\n";
    for (const ChildRule& child : rule.children) {
      out += "      <xs:element name=\"" + dialect.rule(child.type).tag + "\" type=\"" + child.type + "\"/>\n";
    }
    out += "    </xs:choice>\n";
  }
  for (const AttributeRule& a : rule.attributes) out += attribute(a, indent);
  if (rule.text != ValueType::none || rule.children.empty()) out += "    </xs:extension></xs:simpleContent>\n";
  return out + "  </xs:complexType>\n";
}

// The parser trims values and takes units after a blank; the patterns allow the same.
std::string simple_types() {
  const std::string blank = "\\s*";
  const std::string number = "-?([0-9]+(\\.[0-9]*)?|\\.[0-9]+)([eE][+\\-]?[0-9]+)?";
  const auto restricted = [](const std::string& name, const std::string& pattern) {
    return "  <xs:simpleType name=\"" + name + "\"><xs:restriction base=\"xs:string\"><xs:pattern value=\"" + pattern +
           "\"/></xs:restriction></xs:simpleType>\n";
  };
  return restricted("NumberValue", blank + number + blank) + restricted("WholeValue", blank + number + blank) +
         restricted("ShareValue", blank + number + blank + "%?" + blank) +
         restricted("LengthValue", blank + number + blank + "(m|km|cm|mm|ft)?" + blank) +
         restricted("ColourValue", blank + "#[0-9a-fA-F]{6}" + blank) +
         restricted("TextValue", blank + "\\S[\\S\\s]*") + restricted("NoValue", blank);
}

}  // namespace

std::string xml_schema(const Dialect& dialect) {
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- Written by: " + dialect.program +
                    " schema. Silva's dialect of XML: " + dialect.about +
                    ". -->\n<xs:schema xmlns:xs=\"http://www.w3.org/2001/XMLSchema\">\n";
  for (const std::string& root : dialect.roots)
    out += "  <xs:element name=\"" + dialect.rule(root).tag + "\" type=\"" + root + "\"/>\n";
  out += simple_types();
  for (const ElementRule& rule : dialect.rules) out += complex_type(rule, dialect);
  return out + "</xs:schema>\n";
}

}  // namespace silvasim::config
