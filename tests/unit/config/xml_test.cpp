// What is no XML, and what hostile XML may not do.
#include "silvasim/config/xml.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <iostream>

#include "silvasim/base/file.h"
#include "tests/unit/config/files.h"

namespace silvasim::config {
namespace {

std::string first_error(const std::string& text) {
  std::vector<base::Diagnostic> errors;
  parse_xml(text, "f.xml", evaluators::dialect(), "Ecosystem", errors);
  return errors.empty() ? "" : to_string(errors.front());
}

TEST(Xml, SaysWhatIsWrongAndWhere) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "f.xml: error: the file has no XML in it"},
      {"<!-- nothing -->", "f.xml:1: error: the file has no element; expected <ecosystem>"},
      {"<ecosystem>", "f.xml:1:1: error: <ecosystem> is not closed before the file ends"},
      {"<ecosystem/>\n<ecosystem/>", "f.xml:2:1: error: a second root element; XML has one"},
      {"<plants/>", "f.xml:1:1: error: the root element is <plants>; expected <ecosystem>"},
      {"<ecosystem>\n  <scnee/>\n</ecosystem>",
       "f.xml:2:3: error: <scnee> is unknown inside <ecosystem>; did you mean \"scene\"?"},
      {"<ecosystem sed=\"1\"/>", "f.xml:1:12: error: <ecosystem> has no attribute \"sed\"; did you mean \"seed\"?"},
      {"<ecosystem seed=\"x\"/>",
       "f.xml:1:12: error: <ecosystem> seed: \"x\" is no number; expected a whole number, 0 to 9007199254740991"},
      {"<ecosystem>words</ecosystem>", "f.xml:1: error: <ecosystem> takes no text, found \"words\""},
      {"<ecosystem a=\"1\" a=\"2\"/>", "f.xml:1:18: error: <ecosystem> a: the attribute stands twice"},
      {"<ecosystem>&bomb;</ecosystem>", "f.xml:1:12: error: unknown entity; write &amp; for an ampersand"},
      {"<!DOCTYPE e [<!ENTITY a \"b\">]><ecosystem/>",
       "f.xml:1:1: error: document type declarations and entities of one's own are not supported"},
      {"<ecosystem name=\"\xFF\"/>", "f.xml:1:18: error: invalid UTF-8; save the file as UTF-8"},
      {"<ecosystem name=\"\xC0\x80\"/>", "f.xml:1:18: error: invalid UTF-8; save the file as UTF-8"},
      {"<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?><ecosystem/>",
       "f.xml:1:1: error: the file says it is in \"ISO-8859-1\"; save it as UTF-8"},
      {"<ecosystem name=\"\x01\"/>", "f.xml:1:18: error: control character that XML does not allow"},
      {"<ecosystem>\n<tiles>\n</ecosystem>",
       "f.xml:3:1: error: </ecosystem> where <tiles> of line 2 is still to be closed"},
      {"<ecosystem></ecosystem></tiles>", "f.xml:1:24: error: </tiles> closes nothing"},
      {"<ecosystem></ecosystem", "f.xml:1:12: error: an end tag must be like </plant>; found the end of the file"},
      {"<ecosystem name=Alps/>", "f.xml:1:12: error: <ecosystem> name: expected name=\"...\""},
      {"<ecosystem name/>", "f.xml:1:12: error: <ecosystem> name: expected name=\"...\""},
      {"<ecosystem name=\"a\"seed=\"1\"/>",
       "f.xml:1:20: error: <ecosystem> seed: a blank is missing before the attribute"},
      {"<ecosystem name=\"a\" ä<", "f.xml:1:21: error: <ecosystem> ä: expected ä=\"...\""},
      {"<ecosystem name=\"a\" =>", "f.xml:1:21: error: <ecosystem>: expected an attribute, > or />; found \"=\""},
      {"<ecosystem name=\"<!--\"><!-- --></ecosystem>",
       "f.xml:1:12: error: <ecosystem> name: < inside the value; write &lt;, or close the value by its quotation mark"},
      {"<ecosystem name=\"&amp\"/>", "f.xml:1:18: error: unknown entity; write &amp; for an ampersand"},
      {"<ecosystem>1 < 2</ecosystem>",
       "f.xml:1:14: error: < must be followed by an element's name; found \" \"; write &lt; for the sign"},
      {"<ecosystem>]]></ecosystem>", "f.xml:1:12: error: ]]> in a text; write ]]&gt;"},
      {"<!-- a -- b --><ecosystem/>", "f.xml:1:8: error: -- inside a comment, which XML does not allow"},
      {"<!-- a <ecosystem/>", "f.xml:1:1: error: a comment is not closed by -->"},
      {"<ecosystem/>words", "f.xml:1:13: error: text outside of the root element"},
      {"\n<?xml version=\"1.0\"?><ecosystem/>",
       "f.xml:2:1: error: the XML declaration must stand at the very start of the file"},
      {"<?xml version=\"2.0\"?><ecosystem/>", "f.xml:1:7: error: XML of version 2.0; version 1.0 is read"},
      {"<ecosystem xml:lang=\"en\"/>", "f.xml:1:12: error: <ecosystem> has no attribute \"xml:lang\""},
      {"<ecosystem xsi:noNamespaceSchemaLocation=\"a\"/>",
       "f.xml:1:12: error: <ecosystem> has no attribute \"xsi:noNamespaceSchemaLocation\""},
      {"<ecosystem xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\">\n<tiles "
       "xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\"/></ecosystem>",
       "f.xml:2:8: error: <tiles> has no attribute \"xmlns:xsi\""},
      {"<ecosystem><corners><![CDATA[ ]]></corners></ecosystem>",
       "f.xml:1: error: <corners> takes no text, found \"\""},
  };
  for (const auto& [text, expected] : cases) EXPECT_EQ(first_error(text), expected) << text;
  EXPECT_EQ(first_error(std::string("<ecosystem\0/>", 13)), "f.xml:1:1: error: not UTF-8 text; save the file as UTF-8");
  EXPECT_EQ(
      first_error("\xEF\xBB\xBF<?xml version=\"1.0\" encoding=\"utf-8\"?><ecosystem name=\"Träger &amp; &#x263A;\"/>"),
      "");
}

TEST(Xml, CommentsAndCharacterDataHoldAnyCharacters) {
  EXPECT_EQ(first_error("<ecosystem><!-- a & b <!DOCTYPE> --></ecosystem>"), "");
}

TEST(Xml, TwoMillionLevelsEndInAnError) {
  std::string deep;
  for (int i = 0; i < 2000000; ++i) deep += "<a>";
  EXPECT_EQ(first_error(deep), "f.xml:1:301: error: elements are nested too deep");
}

// Each of these took time in the square of its length once.
TEST(Xml, LongLinesAndManyAttributesAreReadInLinearTime) {
  std::string attributes = "<ecosystem", elements = "<ecosystem>";
  for (int i = 0; i < 1'000'000; ++i) attributes += " a" + std::to_string(i) + "=\"1\"";
  EXPECT_EQ(first_error(attributes + "/>"), "f.xml:1:802: error: <ecosystem> has more than 100 attributes");
  for (int i = 0; i < 400'000; ++i) elements += "<tiles a=\"1\" mode=\"x\"/>";
  std::vector<base::Diagnostic> errors;
  const auto start = std::chrono::steady_clock::now();
  parse_xml(elements + "</ecosystem>", "f.xml", evaluators::dialect(), "Ecosystem", errors);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60)) << "some seconds are usual";
  ASSERT_EQ(errors.size(), base::most_diagnostics + 1);
  EXPECT_EQ(errors.back().message, "... and more");
  EXPECT_EQ(errors[2].place.column, 12 + 23 + 7);
}

TEST(Xml, AHugeAttributeEndsInAnError) {
  const std::string huge = "<ecosystem name=\"" + std::string(100u << 20, 'x') + "\"/>";
  EXPECT_NE(first_error(huge).find("a configuration has at most"), std::string::npos);
}

TEST(Xml, SecondElementOnALineHasItsOwnColumn) {
  std::vector<base::Diagnostic> errors;
  parse_xml("<ecosystem><corners solver=\"a\"/><corners solver=\"b\"/></ecosystem>", "f", evaluators::dialect(),
            "Ecosystem", errors);
  ASSERT_EQ(errors.size(), 3u);
  EXPECT_EQ(errors[0].place.column, 21);
  EXPECT_EQ(errors[1].place.column, 42);
  EXPECT_EQ(errors[2].message, "<ecosystem> takes only one <corners>");
}

// Every malformed file of the shared collection must be refused with one line that has a place.
TEST(Xml, MalformedCollectionIsRefused) {
  const std::filesystem::path folder = std::string(SILVA_SHARED_DIR) + "/data/malformed/xml";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "SKIPPED: there is no " << folder;
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    ++files;
    Files scenario;
    scenario.add("ecosystem.xml", base::read_file(entry.path(), 1u << 30));
    const std::string errors = scenario.errors();
    EXPECT_NE(errors.find("error: "), std::string::npos) << entry.path();
    EXPECT_LT(errors.size(), 100000u) << entry.path();
  }
  EXPECT_GT(files, 20);
  std::cout << files << " malformed files refused\n";
}

}  // namespace
}  // namespace silvasim::config
