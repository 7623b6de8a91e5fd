#include <gtest/gtest.h>

#include "fields.h"

namespace ghosttile::density::test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const Box3 everywhere{V3d(-infinity), V3d(infinity)};

// How much a value may change between floats and doubles: a jump has another value within a hair's breadth.
void expect_same(const Node& node, const V3d& p, float got) {
  const double want = value_of(node, p);
  if (std::abs(want - static_cast<double>(got)) < 2e-4) return;
  double low = want, high = want;
  for (int i = 0; i < 27; ++i) {
    const V3d moved = p + V3d(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1) * 1e-5;
    low = std::min(low, value_of(node, moved));
    high = std::max(high, value_of(node, moved));
  }
  EXPECT_GE(got, low - 2e-4) << name_of(node.kind) << " at " << p;
  EXPECT_LE(got, high + 2e-4) << name_of(node.kind) << " at " << p;
}

TEST(Primitives, EachEqualsTheDoublePrecisionFormula) {
  for (int kind = 0; kind <= static_cast<int>(Kind::column); ++kind) {
    for (unsigned seed = 0; seed < 60; ++seed) {
      SCOPED_TRACE(std::string(name_of(static_cast<Kind>(kind))) + ", seed " + std::to_string(seed));
      const V3d middle(300000, -5000000, 1500);
      Maker maker(seed, middle);
      const Node node = maker.leaf(static_cast<Kind>(kind));
      const V3d corner = middle + V3d(0.3, -0.7, 0.2);
      const Box3 box{middle - V3d(5, 5, 3), middle + V3d(5, 5, 3)};
      const auto places = places_in(box, corner, 2000, maker.random);
      const auto values = values_at(Field(node).compiled(corner, box), places);
      for (std::size_t i = 0; i < places.size(); ++i) expect_same(node, corner + V3d(places[i]), values[i]);
    }
  }
}

TEST(Primitives, OperatorsEqualTheirFormulas) {
  for (unsigned seed = 0; seed < 600; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const V3d middle(1000, 2000, 100);
    Maker maker(seed, middle);
    const Node node = maker.tree(3, false);
    const Box3 box{middle - V3d(4, 4, 2), middle + V3d(4, 4, 2)};
    const auto places = places_in(box, middle, 1000, maker.random);
    const auto values = values_at(Field(node).compiled(middle, box), places);
    for (std::size_t i = 0; i < places.size(); ++i) expect_same(node, middle + V3d(places[i]), values[i]);
  }
}

// A field of one solid: 1 exactly inside, so that what it is taken from is 0 exactly.
TEST(Primitives, NothingIsLeftInsideOfASolidThatIsTakenAway) {
  std::size_t inside = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Maker maker(seed, V3d(0));
    const Kind kinds[] = {Kind::box, Kind::cylinder, Kind::sphere, Kind::layer, Kind::above};
    Node differ;
    differ.kind = Kind::differ;
    differ.children = {maker.leaf(Kind::constant), maker.leaf(kinds[seed % 5])};
    differ.children[0].value = 1;
    const Box3 box{V3d(-3, -3, -2), V3d(3, 3, 2)};
    const auto places = places_in(box, V3d(0), 4000, maker.random);
    const auto values = values_at(Field(differ).compiled(V3d(0), box), places);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Node& solid = differ.children[1];
      bool deep = true;  // a hair's breadth inside
      for (int k = 0; k < 6; ++k) {
        V3d moved(places[i]);
        moved[k / 2] += k % 2 ? 1e-5 : -1e-5;
        deep = deep && (solid.kind == Kind::above ? value_of(solid, moved) == 1 : distance_of(solid, moved) == 0);
      }
      if (!deep) continue;
      ++inside;
      EXPECT_EQ(values[i], 0) << V3d(places[i]);
    }
  }
  EXPECT_GT(inside, 10000u);
}

TEST(Primitives, DegenerateOnesAreWhatTheyShrinkTo) {
  Node point, segment, cylinder, disc, sphere;
  point.kind = Kind::point;
  point.points = {V3d(1, 2, 0.5)};
  point.radius_m = 0.8;
  segment = cylinder = disc = sphere = point;
  segment.kind = Kind::segment;
  segment.points.push_back(segment.points[0]);
  cylinder = segment;
  cylinder.kind = Kind::cylinder;
  disc.kind = Kind::disc;
  sphere.kind = Kind::sphere;
  std::mt19937 random(7);
  const Box3 box{V3d(0, 1, 0), V3d(2, 3, 1)};
  const auto places = places_in(box, V3d(0), 2000, random);
  const auto want = values_at(Field(point).compiled(V3d(0), box), places);
  for (const Node& node : {segment, cylinder, disc, sphere}) {
    const auto got = values_at(Field(node).compiled(V3d(0), box), places);
    for (std::size_t i = 0; i < places.size(); ++i) EXPECT_NEAR(got[i], want[i], 2e-6) << name_of(node.kind);
  }
  EXPECT_GT(*std::max_element(want.begin(), want.end()), 0.5f);
}

// Smooth ones: two places a little apart never differ by more than the falloff's steepest slope allows.
TEST(Primitives, ValuesDoNotJump) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Maker maker(seed, V3d(0));
    const Kind kinds[] = {Kind::point, Kind::segment, Kind::curve,    Kind::disc,
                          Kind::box,   Kind::sphere,  Kind::cylinder, Kind::layer};
    Node node = maker.leaf(kinds[seed % 8]);
    node.radius_m = std::max(node.radius_m, 0.3);
    node.core = std::min(node.core, 0.5);
    if (seed % 3 == 0) {
      Node warp;
      warp.kind = Kind::warp;
      warp.size.x = 0.1;
      warp.radius_m = 0.7;
      warp.seed = seed;
      warp.children = {node};
      node = warp;
    }
    const Box3 box{V3d(-4, -4, -2), V3d(4, 4, 2)};
    auto places = places_in(box, V3d(0), 3000, maker.random);
    const Compiled field = Field(node).compiled(V3d(0), box);
    const auto here = values_at(field, places);
    const float step_m = 1e-3f;
    for (std::size_t i = 0; i < places.size(); ++i) places[i][static_cast<int>(i % 3)] += i % 2 ? step_m : -step_m;
    const auto there = values_at(field, places);
    // |d/dt (1 - t^2)^3| <= 1.72; t changes by 1 / (0.3 * 0.5) a metre; the ground's waves and the warp add their slopes.
    for (std::size_t i = 0; i < places.size(); ++i)
      EXPECT_LE(std::abs(here[i] - there[i]), 1.72f / 0.15f * 3 * step_m) << V3d(places[i]);
  }
}

TEST(Primitives, BoundsHoldEverythingAndAreNear) {
  for (unsigned seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Maker maker(seed, V3d(0));
    const Field field(maker.tree(2, true));
    const Box3 bounds = field.bounds(), box{V3d(-8, -8, -6), V3d(8, 8, 6)};
    const auto places = places_in(box, V3d(0), 3000, maker.random);
    const auto values = values_at(field.compiled(V3d(0), box), places);
    for (std::size_t i = 0; i < places.size(); ++i) {
      bool out = false;
      for (int k = 0; k < 3; ++k)
        out = out || static_cast<double>(places[i][k]) < bounds.least[k] ||
              static_cast<double>(places[i][k]) > bounds.most[k];
      if (out) {
        EXPECT_EQ(values[i], 0) << V3d(places[i]);
      }
    }
  }
  Node sphere;
  sphere.kind = Kind::sphere;
  sphere.points = {V3d(10, 20, 30)};
  sphere.size.x = 2;
  sphere.radius_m = 1;
  const Box3 bounds = Field(sphere).bounds();
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(bounds.least[k], sphere.points[0][k] - 3, 1e-3);
    EXPECT_NEAR(bounds.most[k], sphere.points[0][k] + 3, 1e-3);
  }
  EXPECT_GT(Field().bounds().least.x, Field().bounds().most.x);
  EXPECT_EQ(Field(sphere).range(everywhere).least, 0);
  EXPECT_EQ(Field(sphere).range(everywhere).most, 1);
}

TEST(Primitives, AWarpMovesAndNoFartherThanItSays) {
  Node sphere, warp;
  sphere.kind = Kind::sphere;
  sphere.points = {V3d(0, 0, 0)};
  sphere.size.x = 1;
  warp.kind = Kind::warp;
  warp.size.x = 0.2;
  warp.radius_m = 0.5;
  warp.seed = 11;
  warp.children = {sphere};
  Node other = warp;
  other.seed = 12;
  std::mt19937 random(3);
  const Box3 box{V3d(-1.5), V3d(1.5)};
  const auto places = places_in(box, V3d(0), 20000, random);
  const auto values = values_at(Field(warp).compiled(V3d(0), box), places);
  const auto others = values_at(Field(other).compiled(V3d(0), box), places);
  std::size_t moved = 0, different = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double d = V3d(places[i]).length();
    const double most_m = 0.2 * std::sqrt(3.0) + 1e-5;
    if (d > 1 + most_m) {
      EXPECT_EQ(values[i], 0);
    }
    if (d < 1 - most_m) {
      EXPECT_EQ(values[i], 1);
    }
    moved += (values[i] > 0) != (d <= 1);
    different += values[i] != others[i];
  }
  EXPECT_GT(moved, places.size() / 50);
  EXPECT_GT(different, places.size() / 50);
  // The noise belongs to the place: another corner sees the same, but for rounding at the rim.
  const V3d corner(-7.3, 4.1, 0.9);
  std::vector<V3> from_corner = places;
  for (V3& p : from_corner) p = V3(V3d(p) - corner);
  const auto seen = values_at(Field(warp).compiled(corner, box), from_corner);
  std::size_t unlike = 0;
  for (std::size_t i = 0; i < places.size(); ++i) unlike += seen[i] != values[i];
  EXPECT_LT(unlike, 5u);
}

}  // namespace
}  // namespace ghosttile::density::test
