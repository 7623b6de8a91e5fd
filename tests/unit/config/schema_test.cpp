// The schema and the parser come from one table: what the parser takes, the schema takes.
#include "silvasim/config/schema.h"

#include <gtest/gtest.h>

#include "silvasim/config/help.h"
#include "silvasim/evaluators/evaluator.h"

namespace silvasim::config {
namespace {

TEST(Schema, TakesThePapersFragments) {
  const std::string schema = xml_schema(evaluators::dialect());
  const auto found = check_against_schema(
      "<ecosystem><datafield name=\"Waterfield\">water.png</datafield><MinMaxEvaluator lethal=\"true\" "
      "optimum=\"false\">"
      "<datafield>Waterfield</datafield><property>MinMaxWater</property></MinMaxEvaluator></ecosystem>",
      "f.xml", schema);
  for (const auto& d : found) ADD_FAILURE() << to_string(d);
}

TEST(Schema, RefusesUnknownElementsAttributesAndWords) {
  const std::string schema = xml_schema(evaluators::dialect());
  for (const char* text :
       {"<ecosystem><foo/></ecosystem>", "<ecosystem foo=\"1\"/>", "<ecosystem><corners solver=\"best\"/></ecosystem>",
        "<ecosystem><tiles side=\"wide\"/></ecosystem>", "<ecosystem><datafield>x</datafield></ecosystem>"}) {
    EXPECT_FALSE(check_against_schema(text, "f.xml", schema).empty()) << text;
  }
}

// Every example of the help is taken by the schema in a type of its own, so hover text never shows what would be refused.
TEST(Schema, TakesEveryExampleOfTheHelp) {
  const Dialect& dialect = evaluators::dialect();
  int examples = 0;
  for (const ElementRule& rule : dialect.rules) {
    if (rule.example.empty() || rule.example.find("...") != std::string::npos) continue;
    std::string schema = xml_schema(dialect);
    const std::string root =
        "  <xs:element name=\"ecosystem\" type=\"Ecosystem\"/>\n  <xs:element name=\"plants\" type=\"Plants\"/>\n";
    const std::size_t at = schema.find(root);
    ASSERT_NE(at, std::string::npos);
    schema.replace(at, root.size(), "  <xs:element name=\"" + rule.tag + "\" type=\"" + rule.type + "\"/>\n");
    for (const auto& d : check_against_schema(rule.example, rule.type, schema))
      ADD_FAILURE() << to_string(d) << "\n" << rule.example;
    ++examples;
  }
  EXPECT_GT(examples, 30);
}

TEST(Help, KnowsEveryElement) {
  const Dialect& dialect = evaluators::dialect();
  for (const std::string& name : element_names(dialect)) EXPECT_NE(help_element(dialect, name), "") << name;
  EXPECT_EQ(help_element(dialect, "NoSuchThing"), "");
  EXPECT_NE(help_element(dialect, "MinMaxEvaluator").find("optimum"), std::string::npos);
}

}  // namespace
}  // namespace silvasim::config
