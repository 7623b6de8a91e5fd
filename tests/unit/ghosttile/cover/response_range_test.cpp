#include "ghosttile/cover/response_range.h"

#include <algorithm>

#include "rule_land.h"
#include "silvasim/config/value.h"

namespace ghosttile::cover::test {

namespace {

std::string said(const char* name, double value) {
  return std::string(" ") + name + "=\"" + silvasim::config::to_text(value) + "\"";
}

std::string points(Random& random, int count, bool steps) {
  std::string xml;
  double x = between(random, -5, 5);
  for (int i = 0; i < count; ++i) {
    xml += "<point" + said("x", x) + said("y", between(random, 0, 1)) + "/>";
    if (!(steps && random() % 4 == 0)) x += between(random, 0.01, 3);
  }
  return xml;
}

std::string random_property(Random& random, int kind) {
  double x[4];
  for (double& one : x) one = between(random, -5, 5);
  std::sort(x, x + 4);
  switch (kind) {
    case 0:
      return "<MinMax" + said("min", x[0]) + said("max", x[1]) + "/>";
    case 1:
      return "<Gauss" + said("mean", x[1]) + said("deviation", between(random, 0.05, 3)) + "/>";
    case 2:
      return "<Trapezoid" + said("a", x[0]) + said("b", x[1]) + said("c", x[2]) + said("d", x[3]) + "/>";
    case 3:
      return "<Table>" + points(random, static_cast<int>(1 + random() % 30), true) + "</Table>";
    case 4:
      return "<Bezier>" + points(random, static_cast<int>(4 + 3 * (random() % 4)), false) + "</Bezier>";
    case 5:
      return "<Classes" + said("otherwise", between(random, 0, 1)) + "><class" + said("code", std::floor(x[1])) +
             said("value", between(random, 0, 1)) + "/><class" + said("code", std::floor(x[1]) + 2) +
             said("value", between(random, 0, 1)) + "/></Classes>";
    default:
      return "<Constant" + said("value", between(random, 0, 1)) + "/>";
  }
}

TEST(ResponseRange, HoldsAllAnswersAndLittleMore) {
  double waste = 0;
  int cases = 0;
  for (std::uint64_t seed = 1; seed <= 700; ++seed) {
    Random random(seed);
    const std::string xml = "<response>" + random_property(random, static_cast<int>(seed % 7)) + "</response>";
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + xml);
    std::vector<silvasim::base::Diagnostic> errors;
    const auto node = parsed(xml, errors, "Response");
    const auto response = silvasim::evaluators::make_response(node.children[0], errors);
    ASSERT_TRUE(errors.empty()) << text_of(errors);
    const ResponseRange range(node.children[0]);
    for (int round = 0; round < 20; ++round) {
      // Wide, narrow, a single value, and a whole one, on which classes lie.
      const auto from =
          static_cast<float>(round % 4 == 3 ? std::floor(between(random, -6, 6)) : between(random, -8, 12));
      const auto until = round % 5 == 0
                             ? from
                             : static_cast<float>(static_cast<double>(from) + std::pow(10, between(random, -3, 1.2)));
      const Range bounds = range.of(*response, {from, until});
      constexpr std::size_t count = 1000;
      std::vector<float> x(count), y(count);
      for (std::size_t i = 0; i < count; ++i) {
        x[i] = i % 2 ? from + (until - from) * (static_cast<float>(i) / count)
                     : std::floor(from + (until - from) * (static_cast<float>(i) / count));
        x[i] = std::clamp(x[i], from, until);
      }
      x[0] = until;
      response->apply(x.data(), y.data(), count);
      const auto [least, most] = std::minmax_element(y.begin(), y.end());
      ASSERT_GE(*least, bounds.least) << from << " to " << until;
      ASSERT_LE(*most, bounds.most) << from << " to " << until;
      if (from == until) {
        ASSERT_EQ(bounds.least, bounds.most);
      }
      waste += static_cast<double>(*least - bounds.least + bounds.most - *most);
      ++cases;
    }
  }
  EXPECT_LT(waste / cases, 0.02);
}

}  // namespace

}  // namespace ghosttile::cover::test
