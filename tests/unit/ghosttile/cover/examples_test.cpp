// The rules that docs/ground-cover.md gives do what it says of them.
#include <fstream>
#include <iterator>

#include "rule_land.h"

namespace ghosttile::cover::test {

namespace {

std::vector<std::string> example_rules() {
  std::ifstream file(SILVA_SOURCE_DIR "/docs/ground-cover.md");
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  std::vector<std::string> rules;
  for (std::size_t at = 0; (at = text.find("```xml\n", at)) != std::string::npos;) {
    at += 7;
    rules.push_back(text.substr(at, text.find("```", at) - at));
  }
  return rules;
}

TEST(ExampleRules, DoWhatTheManualSays) {
  const std::vector<std::string> xml = example_rules();
  ASSERT_EQ(xml.size(), 6u);
  Random random(11);
  TestLand land = random_land(random);
  std::vector<std::shared_ptr<const density::Plane>> rules;
  for (const std::string& rule : xml) {
    std::vector<silvasim::base::Diagnostic> errors;
    const auto node = parsed(rule, errors);
    rules.push_back(make_rule(node, land.land, errors));
    ASSERT_TRUE(errors.empty()) << rule << text_of(errors);
  }
  const std::vector<Stem> stems = all_stems(*land.plants);
  std::vector<double> sums(rules.size(), 0);
  for (int k = 0; k < 4000; ++k) {
    const auto at = random_place(random, land.plants->ecosystem().extent);
    bool leaves_near = false, needles_near = false;
    for (const Stem& stem : stems) {
      const bool needles = land.plants->species()[stem.species].habit.needles;
      const double beyond = std::hypot(at.x - stem.x_m, at.y - stem.y_m) - static_cast<double>(stem.radius_m);
      if (beyond < (needles ? 0.7 : 2.4)) (needles ? needles_near : leaves_near) = true;
    }
    for (std::size_t r = 0; r < rules.size(); ++r) {
      const float zero = 0;
      float value = -1;
      rules[r]->sample({at.x, at.y, 0}, &zero, &zero, 1, &value);
      sums[r] += static_cast<double>(value);
      if (r == 0 && !leaves_near) {
        ASSERT_EQ(value, 0);
      }
      if (r == 1 && !needles_near) {
        ASSERT_EQ(value, 0);
      }
    }
  }
  for (std::size_t r = 0; r < rules.size(); ++r) {
    EXPECT_GT(sums[r], 10) << xml[r];
    EXPECT_LT(sums[r], 3900) << xml[r];
  }
}

}  // namespace

}  // namespace ghosttile::cover::test
