#include <gtest/gtest.h>

#include <bit>

#include "fields.h"

namespace ghosttile::density::test {
namespace {

// All points of the box, its corners too.
std::vector<V3> samples(const Box3& box, const V3d& corner, std::size_t count, std::mt19937& random) {
  auto places = places_in(box, corner, count, random);
  for (int i = 0; i < 8; ++i)
    for (int k = 0; k < 3; ++k)
      places[static_cast<std::size_t>(i)][k] =
          static_cast<float>((i >> k & 1 ? box.most[k] : box.least[k]) - corner[k]);
  return places;
}

// Halves a box again and again: the values stay the same to the bit and lie within the range.
TEST(Cut, HalvingKeepsEveryBitAndRangesHold) {
  std::size_t points = 0, folded = 0;
  for (unsigned seed = 0; seed < 1500; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const V3d middle = seed % 2 ? V3d(0) : V3d(412345.5, 5212345.25, 812.5);
    Maker maker(seed, middle);
    const Field whole(maker.tree(1 + static_cast<int>(seed % 4), true));
    Box3 box{middle - V3d(6, 6, 3), middle + V3d(6, 6, 3)};
    Field cut = whole.within(box);
    for (int halving = 0; halving < 14; ++halving) {
      int longest = 0;
      for (int k = 1; k < 3; ++k)
        if (box.most[k] - box.least[k] > box.most[longest] - box.least[longest]) longest = k;
      (maker.pick(2) ? box.least : box.most)[longest] = 0.5 * (box.least[longest] + box.most[longest]);
      cut = cut.within(box);
      // A corner in the box, or some of its diagonals away.
      V3d corner = box.least;
      if (halving % 3 == 1) corner += (box.most - box.least) * maker.between(-8, 8);
      const auto places = samples(box, corner, 200, maker.random);
      const Compiled after = cut.compiled(corner, box);
      const Box3 around{middle - V3d(7, 7, 4), middle + V3d(7, 7, 4)};
      const auto want = values_at(whole.compiled(corner, around), places), got = values_at(after, places);
      const Range range = whole.range(box);
      folded += after.constant();
      for (std::size_t i = 0; i < places.size(); ++i) {
        ASSERT_EQ(std::bit_cast<std::uint32_t>(want[i]), std::bit_cast<std::uint32_t>(got[i]))
            << want[i] << " and " << got[i] << " at " << V3d(places[i]) + corner << ", halving " << halving;
        ASSERT_GE(got[i], after.range.least);
        ASSERT_LE(got[i], after.range.most);
        ASSERT_GE(got[i], range.least);
        ASSERT_LE(got[i], range.most);
      }
      points += places.size();
    }
  }
  EXPECT_GT(points, 4000000u);
  EXPECT_GT(folded, 1000u);
}

// A box that touches a rim from outside or from inside, as near as doubles can: what floats see there is kept.
TEST(Cut, KeepsEveryBitWhereABoxTouchesARim) {
  std::size_t alive = 0, dead = 0;
  for (unsigned seed = 0; seed < 30000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const V3d middle(512345.7, 5412345.3, 812.1);
    Maker maker(seed, middle);
    const Kind kinds[] = {Kind::point, Kind::sphere, Kind::box, Kind::cylinder, Kind::segment, Kind::disc};
    Node node = maker.leaf(kinds[seed % 6]);
    if (maker.pick(2)) node.core = 1;  // sharp: 1 on one side, 0 on the other
    node.turn_deg = 0;
    node.axis = V3d(0, 0, 1);
    if (node.points.size() > 1) node.points[1] = node.points[0] + V3d(0, 0, maker.between(0.2, 2));
    const double solid_m = node.kind == Kind::point || node.kind == Kind::segment ? 0 : node.size.x;
    const bool inside = maker.pick(2);
    // The box's face is where the value gets 0, or where it stops to be 1.
    const double rim_x = node.points[0].x + solid_m + node.radius_m * (inside ? node.core : 1);
    const double side_m = inside ? std::min(0.5, solid_m + node.radius_m * node.core) : 0.5;
    const double nudge_m = maker.between(-1, 1) * 1e-8;
    Box3 box;
    box.least = V3d(rim_x + nudge_m - (inside ? side_m : 0), node.points[0].y - 0.001, node.points[0].z);
    box.most = V3d(rim_x + nudge_m + (inside ? 0 : side_m), node.points[0].y + 0.001, node.points[0].z + 0.001);
    const V3d corner = box.least + V3d(maker.between(-3, 3), maker.between(-3, 3), maker.between(-1, 1));
    auto places = samples(box, corner, 32, maker.random);
    for (std::size_t i = 8; i < places.size(); ++i)
      places[i].x = static_cast<float>((inside ? box.most.x : box.least.x) - corner.x);
    const Box3 around{middle - V3d(7, 7, 4), middle + V3d(7, 7, 4)};
    const Field field(node);
    const auto want = values_at(field.compiled(corner, around), places);
    const Compiled after = field.within(box).compiled(corner, box);
    const auto got = values_at(after, places);
    for (std::size_t i = 0; i < places.size(); ++i) {
      ASSERT_EQ(std::bit_cast<std::uint32_t>(want[i]), std::bit_cast<std::uint32_t>(got[i]))
          << want[i] << " " << got[i];
      ASSERT_GE(got[i], after.range.least);
      ASSERT_LE(got[i], after.range.most);
      ++(got[i] > 0 ? alive : dead);
    }
  }
  EXPECT_GT(alive, 100000u);
  EXPECT_GT(dead, 100000u);
}

// In small boxes a range is hardly wider than what is there: bounded by how steep the falloff can be.
TEST(Cut, RangesAreNotSillyWide) {
  const Kind kinds[] = {Kind::point, Kind::segment, Kind::disc, Kind::box, Kind::sphere, Kind::cylinder, Kind::layer};
  for (unsigned seed = 0; seed < 2000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Maker maker(seed, V3d(0));
    Node node = maker.leaf(kinds[seed % 7]);
    node.radius_m = std::max(node.radius_m, 0.2);
    node.core = std::min(node.core, 0.8);
    Box3 box{maker.place(), V3d(0)};
    const double side_m = maker.between(0.05, 0.3);
    box.most = box.least + V3d(side_m);
    const Range range = Field(node).range(box);
    const auto values = values_at(Field(node).compiled(box.least, box), samples(box, box.least, 256, maker.random));
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    // Twice the change over half a diagonal, and the change over the gaps between samples; the waves add a little.
    const double steepest = 1.72 / (node.radius_m * (1 - node.core));
    const double room = steepest * side_m * (node.kind == Kind::layer ? 2.5 : 1.8) + 1e-4;
    EXPECT_LE(range.most, *most + room);
    EXPECT_GE(range.least, *least - room);
  }
}

TEST(Cut, WhatIsFarVanishesAndWhatIsFullIsConstant) {
  Node haystacks;
  haystacks.kind = Kind::blend;
  for (int i = 0; i < 40; ++i) {
    Node stack;
    stack.kind = Kind::cylinder;
    stack.points = {V3d(10.0 * i, 0, 0), V3d(10.0 * i, 0, 2)};
    stack.size.x = 1.5;
    stack.radius_m = 0.3;
    haystacks.children.push_back(stack);
  }
  const Field field(haystacks);
  EXPECT_TRUE(field.compiled(V3d(15, 0, 0), {V3d(14.8, 0, 0), V3d(15.3, 0.5, 0.5)}).empty());
  EXPECT_TRUE(field.within({V3d(14.8, 0, 0), V3d(15.3, 0.5, 0.5)}).empty());
  EXPECT_FALSE(field.empty());
  EXPECT_TRUE(Field().empty());
  const Compiled full = field.compiled(V3d(20, 0, 0.5), {V3d(19.8, -0.2, 0.5), V3d(20.3, 0.3, 1)});
  EXPECT_TRUE(full.constant());
  EXPECT_EQ(full.range.least, 1);
  const Compiled rim = field.compiled(V3d(21, 0, 0.5), {V3d(21.2, 0, 0.5), V3d(21.7, 0.5, 1)});
  EXPECT_FALSE(rim.constant());
  EXPECT_TRUE(Field().compiled(V3d(0), {V3d(0), V3d(1)}).empty());
}

TEST(Cut, OnePlaneIsSampledOnceABlock) {
  struct Counting final : Plane {
    mutable int calls = 0;
    void sample(const V3d&, const float*, const float*, std::size_t count, float* value) const override {
      ++calls;
      std::fill_n(value, count, 0.1f);
    }
    Range bounds(double, double, double, double) const override { return {0, 0.5f}; }
  };
  const auto plane = std::make_shared<Counting>();
  Node all, layer, above, column;
  layer.kind = Kind::layer;
  layer.to_m = 0.2;
  layer.radius_m = 0.3;
  layer.plane = above.plane = column.plane = plane;
  above.kind = Kind::above;
  column.kind = Kind::column;
  all.kind = Kind::multiply;
  all.children = {layer, above, column};
  const Box3 box{V3d(0, 0, -0.2), V3d(0.5)};
  const Compiled field = Field(all).compiled(V3d(0), box);
  const auto values = values_at(field, {V3(0.1f, 0.1f, 0.2f)});
  EXPECT_EQ(plane->calls, 1);
  EXPECT_FLOAT_EQ(values[0], 0.1f);
}

}  // namespace
}  // namespace ghosttile::density::test
