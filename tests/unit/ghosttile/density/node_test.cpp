#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fields.h"
#include "silvasim/base/error.h"

namespace ghosttile::density::test {
namespace {

using testing::HasSubstr;

Node point() {
  Node node;
  node.kind = Kind::point;
  node.points = {V3d(0)};
  node.radius_m = 1;
  return node;
}

Node of(Kind kind, std::vector<Node> children) {
  Node node;
  node.kind = kind;
  node.children = std::move(children);
  return node;
}

TEST(Node, RandomTreesHaveNoProblem) {
  for (unsigned seed = 0; seed < 300; ++seed) EXPECT_EQ(problem_with(Maker(seed, V3d(0)).tree(4, true)), "") << seed;
}

TEST(Node, ProblemsAreToldInWords) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Case {
    const char* words;
    Node node;
  };
  std::vector<Case> cases;
  const auto add = [&](const char* words, Node node, auto change) {
    change(node);
    cases.push_back({words, std::move(node)});
  };
  add("a point has a point that is not a number", point(), [&](Node& n) { n.points[0].y = nan; });
  add("a point has a point that is not a number or too large", point(), [&](Node& n) { n.points[0].y = 1e12; });
  add("a point has a value that is not a number", point(), [&](Node& n) { n.radius_m = nan; });
  add("a point has a value that is not a number", point(), [&](Node& n) { n.core = nan; });
  add("a point has a radius_m of 0", point(), [](Node& n) { n.radius_m = 0; });
  add("a point has a radius_m below 0", point(), [](Node& n) { n.radius_m = -1; });
  add("a point has a core outside of 0 to 1", point(), [](Node& n) { n.core = 1.5; });
  add("a point has 0 points; give one", point(), [](Node& n) { n.points.clear(); });
  add("a point has children", point(), [](Node& n) { n.children = {point()}; });
  add("a curve has 0 points; give two or more", point(), [](Node& n) {
    n.kind = Kind::curve;
    n.points.clear();
  });
  add("a cylinder has 1 points; give two, its ends", point(), [](Node& n) { n.kind = Kind::cylinder; });
  add("a disc has no axis", point(), [](Node& n) {
    n.kind = Kind::disc;
    n.axis = V3d(0);
  });
  add("a sphere has a size below 0", point(), [](Node& n) {
    n.kind = Kind::sphere;
    n.size.x = -1;
  });
  add("a sphere has a size or axis that is not a number", point(), [&](Node& n) {
    n.kind = Kind::sphere;
    n.size.x = nan;
  });
  add("a layer has no plane", of(Kind::layer, {}), [](Node&) {});
  add("a layer has from_m above to_m", of(Kind::layer, {}), [](Node& n) { n.from_m = 1; });
  add("a blend has no children", of(Kind::blend, {}), [](Node&) {});
  add("a warp has 2 children", of(Kind::warp, {point(), point()}), [](Node&) {});
  add("a warp has a radius_m below a millimetre", of(Kind::warp, {point()}), [](Node&) {});
  add("a scale has 0 children", of(Kind::scale, {}), [](Node&) {});
  add("a constant has a value outside of 0 to 1e6", of(Kind::constant, {}), [](Node& n) { n.value = -0.1; });
  add("a sphere has 0 points", of(Kind::unite, {point(), of(Kind::sphere, {})}), [](Node&) {});
  Node deep = point();
  for (int i = 0; i < 300; ++i) deep = of(Kind::scale, {deep});
  add("deeper than 200", deep, [](Node&) {});
  for (const Case& one : cases) {
    EXPECT_THAT(problem_with(one.node), HasSubstr(one.words));
    EXPECT_THROW(Field{one.node}, silvasim::base::Error) << one.words;
  }
}

}  // namespace
}  // namespace ghosttile::density::test
