// The parser and the schema agree: what the loader takes, any XML parser and the schema take too.
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iostream>
#include <map>
#include <random>

#include "silvasim/base/file.h"
#include "silvasim/config/load.h"
#include "silvasim/config/schema.h"
#include "silvasim/evaluators/evaluator.h"

namespace silvasim::config {
namespace {

namespace fs = std::filesystem;

// A copy of the examples that may be spoilt; the data they name stay where they are.
class Examples {
 public:
  Examples() : folder_(fs::temp_directory_path() / ("silva-agreement-" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
    fs::copy(fs::path(SILVA_SOURCE_DIR) / "configs", folder_ / "configs", fs::copy_options::recursive);
    fs::create_directory_symlink(fs::path(SILVA_SOURCE_DIR) / "data", folder_ / "data");
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / "configs")) {
      // Cameras are silvavis's and details ghosttile's, in languages of their own.
      if (entry.path().extension() == ".xml" && entry.path().filename() != "cameras.xml" &&
          fs::exists(entry.path().parent_path() / "ecosystem.xml"))
        texts_[entry.path()] = base::read_file(entry.path(), 1u << 20);
    }
  }
  ~Examples() { fs::remove_all(folder_); }
  const std::map<fs::path, std::string>& texts() const { return texts_; }

 private:
  fs::path folder_;
  std::map<fs::path, std::string> texts_;
};

void write(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

class Mutator {
 public:
  explicit Mutator(unsigned seed) : random_(seed) {}

  std::string operator()(std::string text) {
    // What formatters, editors and typing errors put where, and plain noise.
    static const std::pair<const char*, std::vector<const char*>> after[] = {
        {">", {"\n", " ", "<!-- x -->", "<!--", "<![CDATA[ ]]>", "<?x?>", "words", "&amp;", "]]>", "</", "<a/>"}},
        {"\"/>", {"\n"}},
        {"=\"", {"<", "<!--", " ", "\n", "&lt;", "&", "\"", "0", "-", "%", "1e", "&#9;"}},
        {"\"", {" ", " xml:lang=\"en\"", " xsi:nil=\"true\"", " xsi:type=\"x\"", " xmlns=\"\"", "\"", " x", "\n", "="}},
        {"<", {" ", "/", "!", "?", "x:", "<"}},
        {"--", {"-", " ", ">"}},
        {" ", {"\n", "  ", "seed=\"1\" ", "name=\"x\" "}}};
    const auto& [place, what] = after[below(std::size(after))];
    const std::size_t at = somewhere(text, place);
    switch (below(6)) {
      case 0:
        text.erase(at, 1 + below(3));
        break;
      case 1:
        text[at - 1] = static_cast<char>(below(128));
        break;
      case 2: {  // an empty element in two tags
        const std::size_t end = somewhere(text, "/>"), start = text.rfind('<', end - 1);
        const std::string tag = text.substr(start + 1, text.find_first_of(" />", start) - start - 1);
        const std::vector<std::string> inside = {"", " ", "\n  ", "<!-- -->", "x"};
        text.replace(end - 2, 2, ">" + inside[below(inside.size())] + "</" + tag + ">");
        break;
      }
      default:
        text.insert(at, what[below(what.size())]);
    }
    return text;
  }

 private:
  std::size_t below(std::size_t bound) { return random_() % bound; }

  // Behind a random occurrence of the word.
  std::size_t somewhere(const std::string& text, const std::string& word) {
    const std::size_t found = text.find(word, below(text.size() * 9 / 10));
    return (found == std::string::npos ? text.find(word) : found) + word.size();
  }

  std::mt19937 random_;
};

TEST(Agreement, WhatTheLoaderTakesTheSchemaTakes) {
  const Examples examples;
  const std::string schema = xml_schema(evaluators::dialect());
  int taken = 0, refused = 0;
  for (unsigned seed = 0; seed < 600; ++seed) {
    Mutator mutate(seed);
    auto example = examples.texts().begin();
    std::advance(example, seed % examples.texts().size());
    const std::string text = mutate(example->second);
    write(example->first, text);
    const fs::path folder = example->first.parent_path();
    try {
      load_scenario(folder / "ecosystem.xml", std::nullopt, evaluators::dialect());
      ++taken;
      for (const auto& d : check_against_schema(text, example->first.string(), schema)) {
        ADD_FAILURE() << "seed " << seed << ": " << to_string(d);
      }
    } catch (const base::ConfigError&) {
      ++refused;
    }
    write(example->first, example->second);
  }
  std::cout << taken << " mutations taken by both, " << refused << " refused by the loader\n";
  EXPECT_GT(taken, 100);
  EXPECT_GT(refused, 100);
}

TEST(Agreement, BothTakeBlanksInElementsWithoutContent) {
  const std::string schema = xml_schema(evaluators::dialect());
  const char* const text = "<plants><plant name=\"a\"><scale most=\"2\">\n</scale></plant></plants>";
  EXPECT_TRUE(check_against_schema(text, "f.xml", schema).empty());
  const char* const wrong = "<plants><plant name=\"a\"><scale most=\"2\">x</scale></plant></plants>";
  EXPECT_FALSE(check_against_schema(wrong, "f.xml", schema).empty());
}

}  // namespace
}  // namespace silvasim::config
