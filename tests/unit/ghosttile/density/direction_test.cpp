#include "ghosttile/density/direction.h"

#include <gtest/gtest.h>

#include "fields.h"
#include "ghosttile/density/size.h"

namespace ghosttile::density::test {
namespace {

const V3d corner(300000, 5000000, 700);

std::vector<V3> directions(const Direction& direction, const std::vector<V3>& places, const Compiled& density = {}) {
  std::vector<float> x, y, z;
  for (const V3& p : places) {
    x.push_back(p.x);
    y.push_back(p.y);
    z.push_back(p.z);
  }
  std::vector<V3> result(places.size(), V3(9));
  Scratch scratch;
  directions_at(direction, corner, {x.data(), y.data(), z.data(), places.size()}, density, scratch, result.data());
  return result;
}

TEST(Direction, TheGradientOfASphereLeadsOutOfIt) {
  Node sphere;
  sphere.kind = Kind::sphere;
  sphere.points = {corner + V3d(0.2, -0.3, 0.1)};
  sphere.size.x = 0.5;
  sphere.radius_m = 1;
  std::mt19937 random(4);
  const Box3 box{corner - V3d(2), corner + V3d(2)};
  const Compiled density = Field(sphere).compiled(corner, box);
  const auto places = places_in(box, corner, 250, random);
  Direction direction;
  direction.kind = DirectionKind::gradient;
  const auto got = directions(direction, places, density);
  int sloping = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const V3d out = V3d(places[i]) - V3d(0.2, -0.3, 0.1);
    const double d = out.length();
    if (d < 0.48 || d > 1.52) {
      EXPECT_EQ(got[i], V3(0)) << d;
    }
    if (d < 0.55 || d > 1.4) continue;
    ++sloping;
    EXPECT_GT(V3d(got[i]).dot(out / d), 0.999) << d;
    EXPECT_NEAR(got[i].length(), 1, 1e-5);
  }
  EXPECT_GT(sloping, 20);
}

TEST(Direction, RotationalRadialVerticalAndConstant) {
  std::mt19937 random(5);
  auto places = places_in({corner - V3d(2), corner + V3d(2)}, corner, 200, random);
  places[0] = V3(1, 0.5f, 0);  // on the axis
  Direction direction;
  direction.centre = corner + V3d(1, 0.5, 100);
  for (const V3& d : directions(direction, places)) EXPECT_EQ(d, V3(0, 0, 1));
  direction.kind = DirectionKind::rotational;
  const auto around = directions(direction, places);
  direction.kind = DirectionKind::radial;
  const auto away = directions(direction, places);
  EXPECT_EQ(around[0], V3(0));
  EXPECT_EQ(away[0], V3(0));
  for (std::size_t i = 1; i < places.size(); ++i) {
    V3 out = places[i] - V3(1, 0.5f, 0);
    out.z = 0;
    out /= out.length();
    EXPECT_LT((away[i] - out).length(), 1e-5f);
    EXPECT_LT((out.cross(around[i]) - V3(0, 0, 1)).length(), 1e-5f);
  }
  direction.kind = DirectionKind::constant;
  direction.vector = V3d(3, 0, 4);
  EXPECT_LT((directions(direction, places)[7] - V3(0.6f, 0, 0.8f)).length(), 1e-6f);
  direction.vector = V3d(0);
  EXPECT_EQ(directions(direction, places)[7], V3(0));
}

TEST(Direction, NormalsOfTheGround) {
  const Waves ground(700, 1.5, 40);
  std::mt19937 random(6);
  const auto places = places_in({corner - V3d(20), corner + V3d(20)}, corner, 200, random);
  Direction direction;
  direction.kind = DirectionKind::normal;
  direction.ground = &ground;
  const auto got = directions(direction, places);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const V3d p = corner + V3d(places[i]);
    const double h = 1e-3;
    V3d want(ground.at(p.x - h, p.y) - ground.at(p.x + h, p.y), ground.at(p.x, p.y - h) - ground.at(p.x, p.y + h),
             2 * h);
    want /= want.length();
    EXPECT_GT(want.dot(V3d(got[i])), 0.99999);
  }
}

TEST(Size, LimitsLeadFromNoneToFull) {
  SizeField size;
  Node shape;
  shape.kind = Kind::point;
  shape.points = {corner};
  shape.radius_m = 1;
  size.field = Field(shape);
  size.where_none = {0.5f, 1};
  size.where_full = {1, 3};
  const Compiled field = size.field.compiled(corner, {corner - V3d(2), corner + V3d(2)});
  const float x[] = {0, 1.5f, 0.5f}, zero[] = {0, 0, 0};
  float least[3], most[3];
  Scratch scratch;
  scale_limits(size, field, {x, zero, zero, 3}, scratch, least, most);
  EXPECT_FLOAT_EQ(least[0], 1);
  EXPECT_FLOAT_EQ(most[0], 3);
  EXPECT_FLOAT_EQ(least[1], 0.5f);
  EXPECT_FLOAT_EQ(most[1], 1);
  const float share = 0.75f * 0.75f * 0.75f;
  EXPECT_FLOAT_EQ(most[2], 1 + 2 * share);
}

}  // namespace
}  // namespace ghosttile::density::test
