// Every species of the project's scenarios has a form of its own.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "assets/grown/form.h"

namespace assets::grown {
namespace {

std::map<std::string, std::string> names_of_the_scenarios() {
  std::map<std::string, std::string> file_of_name;
  for (const char* folder : {"configs", "bench/scenes", "tests/places"}) {
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(std::filesystem::path(SILVA_SOURCE_DIR) / folder)) {
      const std::string file = entry.path().filename().string();
      if (!file.ends_with("plants.xml")) continue;
      std::ifstream in(entry.path());
      std::stringstream text;
      text << in.rdbuf();
      const std::string all = text.str();
      const std::regex plant("<plant\\s[^>]*name=\"([^\"]+)\"");
      for (auto i = std::sregex_iterator(all.begin(), all.end(), plant); i != std::sregex_iterator(); ++i)
        file_of_name[(*i)[1]] = entry.path().string();
      // A plant without a name is called after its model.
      const std::regex model("<model>\\s*\\S*?([a-z]+)\\.obj\\s*</model>");
      for (auto i = std::sregex_iterator(all.begin(), all.end(), model); i != std::sregex_iterator(); ++i)
        file_of_name[(*i)[1]] = entry.path().string();
    }
  }
  return file_of_name;
}

std::string name_of_form(const std::string& name) { return form_of(name, 20, 4).name; }

TEST(GrownNames, EverySpeciesOfTheScenariosIsKnown) {
  const auto names = names_of_the_scenarios();
  ASSERT_GT(names.size(), 45u);
  for (const auto& [name, file] : names) {
    bool known = false;
    const Form form = form_of(name, 20, 4, &known);
    EXPECT_TRUE(known) << name << " in " << file;
    EXPECT_NE(form.name, "broadleaf") << name;
    EXPECT_NE(form.name, "conifer") << name;
    EXPECT_NE(form.name, "shrub") << name;
  }
}

TEST(GrownNames, SpeciesComeBeforeGenera) {
  EXPECT_EQ(name_of_form("Quercus petraea"), "oak");
  EXPECT_EQ(name_of_form("Quercus rubra"), "red oak");
  EXPECT_EQ(name_of_form("Betula pendula"), "birch");
  EXPECT_EQ(name_of_form("Betula nigra"), "river birch");
  EXPECT_EQ(name_of_form("Abies alba"), "fir");
  EXPECT_EQ(name_of_form("Abies lasiocarpa"), "subalpine fir");
  EXPECT_EQ(name_of_form("Salix cinerea"), "shrub willow");
  EXPECT_EQ(name_of_form("Salix fragilis"), "willow");
  EXPECT_EQ(name_of_form("Pinus sylvestris"), "pine");
  EXPECT_EQ(name_of_form("Pinus albicaulis"), "whitebark pine");
  EXPECT_EQ(name_of_form("Pseudotsuga menziesii"), "Douglas fir");
  EXPECT_EQ(name_of_form("Tsuga heterophylla"), "hemlock");
}

TEST(GrownNames, WordsAreWholeAndLettersOfAnyCase) {
  EXPECT_EQ(name_of_form("oak"), "oak");
  EXPECT_EQ(name_of_form("OAK"), "oak");
  EXPECT_EQ(name_of_form("Common Oak"), "oak");
  EXPECT_EQ(name_of_form("picea_abies"), "spruce");
  EXPECT_EQ(name_of_form("Picea abies var. alpestris"), "spruce");
  bool known = true;
  form_of("Oakley", 20, 4, &known);
  EXPECT_FALSE(known);
  form_of("Frangula", 4, 1, &known);
  EXPECT_TRUE(known);
  // "alnus" is also the second word of alder buckthorn.
  EXPECT_EQ(form_of("Frangula alnus", 4, 1.3).name, "buckthorn");
  for (const std::string& name : {std::string(), std::string(" "), std::string("\xff\xfe\x80"),
                                  std::string(100000, 'q'), std::string("a\0b", 3)}) {
    form_of(name, 20, 4, &known);
    EXPECT_FALSE(known);
  }
}

TEST(GrownNames, StrangersAreShapedByTheirSize) {
  EXPECT_EQ(form_of("Ignotum ignotum", 0.3, 0.2).name, "herb");
  EXPECT_EQ(form_of("Ignotum ignotum", 4, 2).name, "shrub");
  EXPECT_EQ(form_of("Ignotum ignotum", 25, 5).name, "broadleaf");
  EXPECT_EQ(form_of("Ignotum ignotum", 40, 2).name, "conifer");
}

TEST(GrownNames, TheTableHasNoNameTwice) {
  std::set<std::string> seen;
  for (const std::string& name : known_names()) EXPECT_TRUE(seen.insert(name).second) << name;
  std::set<std::string> forms;
  for (const Form& form : all_forms()) EXPECT_TRUE(forms.insert(form.name).second) << form.name;
}

}  // namespace
}  // namespace assets::grown
