#include "ghosttile/cover/rule.h"

#include <gmock/gmock.h>

#include "rule_land.h"

namespace ghosttile::cover::test {

namespace {

using ::testing::HasSubstr;

float one(const density::Plane& plane, double x, double y) {
  const float zero = 0;
  float value = -1;
  plane.sample({x, y, 0}, &zero, &zero, 1, &value);
  return value;
}

std::shared_ptr<const density::Plane> rule_of(const std::string& xml, Land& land) {
  std::vector<silvasim::base::Diagnostic> errors;
  const auto node = parsed(xml, errors);
  auto rule = make_rule(node, land, errors);
  EXPECT_TRUE(errors.empty()) << text_of(errors);
  EXPECT_TRUE(rule);
  return rule;
}

std::string errors_of(const std::string& xml, Land& land) {
  std::vector<silvasim::base::Diagnostic> errors;
  const auto node = parsed(xml, errors);
  EXPECT_TRUE(errors.empty()) << text_of(errors);
  const auto rule = make_rule(node, land, errors);
  EXPECT_EQ(rule == nullptr, !errors.empty());
  return text_of(errors);
}

const char* const parts[] = {
    "<response><crowncover species='Fagus sylvatica, Quercus' reach='1 m'/></response>",
    "<response><light/><Table><point x='0.2' y='0.1'/><point x='0.7' y='1'/></Table></response>",
    "<response><datafield>to_water</datafield><Trapezoid a='0' b='3' c='7' d='9'/></response>",
    "<response><datafield>soil</datafield><Classes otherwise='0.5'><class code='3' value='1'/><class code='5' "
    "value='0'/></Classes></response>",
    "<response><datafield>moisture</datafield><Gauss mean='5' deviation='2'/></response>",
    "<response><slope/><Bezier><point x='0' y='1'/><point x='20' y='1'/><point x='30' y='0.2'/><point x='60' "
    "y='0'/></Bezier></response>",
    "<response><stemdistance layer='trees' most='5 m'/><Table><point x='0' y='0.2'/><point x='2' "
    "y='1'/></Table></response>",
    "<response><patches size='2 m'/></response>",
    "<response><standdensity/><Table><point x='0' y='1'/><point x='300' y='0.3'/></Table></response>",
    "<response><elevation/><MinMax min='305' max='325'/></response>",
    "<response><litter species='broadleaf' reach='2 m'/></response>",
};

// A rule of all parts answers with the product, the least or the greatest of what each part's own rule says.
TEST(Rule, CombinesItsParts) {
  Random random(1);
  TestLand land = random_land(random);
  for (const char* word : {"product", "least", "greatest"}) {
    std::string xml = std::string("<where combine='") + word + "'>";
    std::vector<std::shared_ptr<const density::Plane>> single;
    for (const char* part : parts) {
      xml += part;
      single.push_back(rule_of("<where>" + std::string(part) + "</where>", land.land));
    }
    // A rule within the rule: one of the parts again.
    xml += std::string("<where>") + parts[0] + parts[1] + "</where></where>";
    const auto whole = rule_of(xml, land.land);
    double sum = 0;
    for (int k = 0; k < 500; ++k) {
      const auto at = random_place(random, grown(land.plants->ecosystem().extent, 5));
      double expected = word[0] == 'g' ? 0 : 1;
      const auto take = [&](double v) {
        expected = word[0] == 'p' ? expected * v : word[0] == 'l' ? std::min(expected, v) : std::max(expected, v);
      };
      for (const auto& rule : single) take(static_cast<double>(one(*rule, at.x, at.y)));
      take(static_cast<double>(one(*single[0], at.x, at.y)) * static_cast<double>(one(*single[1], at.x, at.y)));
      ASSERT_NEAR(one(*whole, at.x, at.y), expected, 1e-6) << word;
      sum += expected;
    }
    EXPECT_GT(sum, 0);
  }
}

TEST(Rule, HasSoundBoundsAndBlocksAreItsPoints) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    TestLand land = random_land(random);
    int bare = 0;
    for (int k = 0; k < 12; ++k) {
      std::string xml = std::string("<where combine='") +
                        (k % 3 == 0   ? "greatest"
                         : k % 3 == 1 ? "least"
                                      : "product") +
                        "'>";
      for (int p = 0; p < 1 + k % 4; ++p) xml += parts[random() % std::size(parts)];
      xml += "</where>";
      const auto rule = rule_of(xml, land.land);
      for (int round = 0; round < 30; ++round) {
        const auto corner = random_place(random, grown(land.plants->ecosystem().extent, 30));
        const double size = std::pow(10, between(random, -2, 2.3));
        const Range range = rule->bounds(corner.x, corner.y, corner.x + size, corner.y + size);
        std::vector<float> x(600), y(600), value(600);
        for (std::size_t i = 0; i < x.size(); ++i) {
          x[i] = static_cast<float>(between(random, 0, size));
          y[i] = static_cast<float>(between(random, 0, size));
        }
        const V3d origin{corner.x, corner.y, 0};
        rule->sample(origin, x.data(), y.data(), x.size(), value.data());
        for (std::size_t i = 0; i < x.size(); ++i) {
          ASSERT_GE(value[i], range.least) << xml;
          ASSERT_LE(value[i], range.most) << xml;
          ASSERT_GE(value[i], 0);
          ASSERT_LE(value[i], 1);
        }
        float alone = -1;
        rule->sample(origin, &x[599], &y[599], 1, &alone);
        ASSERT_EQ(alone, value[599]);
        bare += range.most == 0 ? 1 : 0;
      }
    }
    EXPECT_GT(bare, 0);  // some boxes are known to be empty
  }
}

TEST(Rule, KnowsTheSeason) {
  Random random(3);
  const auto plants = std::make_shared<const Plants>(random_ecosystem(random));
  const std::string xml = "<where><response><litter species='Quercus'/></response></where>";
  Land august(plants, nullptr, {8.5, 1, 1 << 20}), november(plants, nullptr, {11.8, 1, 1 << 20});
  const auto thin = rule_of(xml, august), thick = rule_of(xml, november);
  const auto said = rule_of("<where><response><litter species='Quercus' month='11.8'/></response></where>", august);
  const float share = litter(habit_of("Quercus robur"), 8.5) / litter(habit_of("Quercus robur"), 11.8);
  EXPECT_LT(share, 0.9f);
  int seen = 0;
  for (const Stem& stem : all_stems(*plants)) {
    if (genus_of(plants->species()[stem.species].name) != "Quercus") continue;
    const float more = one(*thick, stem.x_m, stem.y_m), less = one(*thin, stem.x_m, stem.y_m);
    EXPECT_GE(more, less);
    EXPECT_EQ(one(*said, stem.x_m, stem.y_m), more);
    if (more < 0.999f * litter(habit_of("Quercus robur"), 11.8) + 1e-3f)
      seen += std::fabs(less / more - share) < 1e-3f ? 1 : 0;
  }
  EXPECT_GT(seen, 5);  // under lone oaks
}

TEST(Rule, NamesWhatIsNotThere) {
  Random random(4);
  TestLand land = random_land(random);
  const auto error = [&](const std::string& response) {
    return errors_of("<where><response>" + response + "</response></where>", land.land);
  };
  EXPECT_EQ(error("<crowncover species='Quercus robur, Fagus silvatica'/>"),
            "rule.xml:1:30: error: species: there is no \"Fagus silvatica\" in this ecosystem; did you mean \"Fagus "
            "sylvatica\"?\n");
  EXPECT_THAT(error("<crowncover species='Zamia'/>"),
              HasSubstr("there is no \"Zamia\" in this ecosystem; there are \"Fagus sylvatica\", \"Quercus robur\""));
  EXPECT_THAT(error("<litter species='brodleaf'/>"), HasSubstr("did you mean \"broadleaf\"?"));
  EXPECT_THAT(error("<light species='Quercus,,Fagus'/>"), HasSubstr("a name is missing between commas"));
  EXPECT_THAT(error("<stemdistance layer='tree'/><Constant value='1'/>"),
              HasSubstr("layer: there is no \"tree\" in this ecosystem; did you mean \"trees\"?"));
  EXPECT_THAT(error("<datafield>to_watr</datafield><Constant value='1'/>"),
              HasSubstr("there is no data field \"to_watr\"; did you mean \"to_water\"?"));
  EXPECT_THAT(error("<slope/>"), HasSubstr("<slope> needs a Property that turns it into a share"));
  EXPECT_THAT(error("<slope/><light/><Constant value='1'/>"), HasSubstr("takes one source: <light> follows <slope>"));
  EXPECT_THAT(error("<slope/><Constant value='1'/><Gauss mean='1' deviation='1'/>"), HasSubstr("takes one Property"));
  EXPECT_THAT(error("<Constant value='1'/>"), HasSubstr("needs a source"));
  EXPECT_THAT(error("<slope/><MinMax min='3' max='2'/>"), HasSubstr("reversed"));
  EXPECT_THAT(errors_of("<where/>", land.land), HasSubstr("<where> needs a <response>"));
  // Groups are no names: a land without any is bare there.
  EXPECT_EQ(error("<crowncover species='needles' layer='shrubs'/>"), "");
}

TEST(Rule, OnALandWithoutFieldsSaysSo) {
  Random random(5);
  Land land(std::make_shared<const Plants>(random_ecosystem(random)), nullptr);
  EXPECT_THAT(
      errors_of("<where><response><datafield>to_water</datafield><Constant value='1'/></response></where>", land),
      HasSubstr("the scene names no ecosystem.xml"));
}

TEST(Rule, SharesSourcesThatAreAlike) {
  Random random(6);
  TestLand land = random_land(random);
  std::vector<silvasim::base::Diagnostic> errors;
  const auto source = [&](const std::string& xml) {
    const auto node = parsed("<response>" + xml + "</response>", errors, "Response");
    return make_source(node.children[0], land.land, errors);
  };
  EXPECT_EQ(source("<crowncover species='Quercus'/>"),
            source("<crowncover species='Quercus robur, Quercus petraea'/>"));
  EXPECT_NE(source("<crowncover species='Quercus'/>"), source("<crowncover species='Quercus' reach='1 m'/>"));
  EXPECT_NE(source("<litter/>"), source("<litter month='3'/>"));
  EXPECT_NE(source("<patches seed='1'/>"), source("<patches seed='2'/>"));
  EXPECT_EQ(source("<light/>"), source("<light/>"));
  EXPECT_NE(source("<light/>"), source("<crowncover/>"));
  EXPECT_TRUE(errors.empty()) << text_of(errors);
}

TEST(Rule, ElementsAreHelpedAndTheirExamplesAreRight) {
  const auto& dialect = rule_dialect();
  for (const auto& rule : cover_rules()) {
    EXPECT_FALSE(rule.help.empty()) << rule.type;
    std::vector<silvasim::base::Diagnostic> errors;
    EXPECT_TRUE(silvasim::config::parse_xml(rule.example, "example", dialect, rule.type, errors));
    EXPECT_TRUE(errors.empty()) << text_of(errors);
  }
}

}  // namespace

}  // namespace ghosttile::cover::test
