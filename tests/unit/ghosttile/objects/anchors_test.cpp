#include "ghosttile/objects/anchors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "ghosttile/objects/make_detail.h"
#include "ghosttile/objects/surface.h"
#include "shapes.h"
#include "silvasim/base/error.h"

namespace {

using namespace ghosttile::objects;
using silvasim::base::Error;

float closest_pair(const std::vector<V3>& points) {
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) least = std::min(least, (points[i] - points[j]).length());
  return least;
}

assets::Model moved(assets::Model m, const V3& by) {
  for (V3& p : m.positions) p += by;
  return m;
}

TEST(Anchors, StandAtTheOriginUnlessAskedElsewhere) {
  EXPECT_EQ(anchors_of(shapes::box({1, 1, 1}), {}), std::vector<V3>{V3(0, 0, 0)});
}

TEST(Anchors, FindCentreAndFoot) {
  const assets::Model m = moved(shapes::box({1, 2, 3}), {5, 6, 7});
  EXPECT_LT((centre_of(m) - V3(5, 6, 7)).length(), 1e-5f);
  EXPECT_LT((foot_of(m) - V3(5, 6, 5.5f)).length(), 1e-5f);
  // A box of volume 1 at 0 and one of volume 8 at x = 9: the centre lies at 8.
  const assets::Model two = shapes::joined(shapes::box({1, 1, 1}), shapes::box({2, 2, 2}), {9, 0, 0});
  EXPECT_NEAR(centre_of(two).x, 8, 1e-4f);
  EXPECT_NEAR(centre_of(moved(shapes::sheet(1, 1, 2), {3, 0, 0})).x, 3, 1e-5f);
}

TEST(Anchors, LieWithinTheVolumeAndApart) {
  const assets::Model m = shapes::joined(shapes::box({4, 0.2f, 0.2f}), shapes::icosphere(0.3f, 2), {2, 0, 0});
  const Surface s = surface_of(m);
  const auto points = anchors_of(m, {.places = AnchorPlaces::volume, .count = 12, .seed = 1});
  ASSERT_EQ(points.size(), 12u);
  for (const V3& p : points) EXPECT_TRUE(inside(s, V3d(p))) << p;
  EXPECT_GT(closest_pair(points), 0.17f);  // 12 along 4.3 m are 0.36 m apart, as many at random 0.03 m
  const auto more = anchors_of(m, {.places = AnchorPlaces::surface, .count = 40, .seed = 1});
  for (const V3& p : more) EXPECT_LT(distance_m(s, V3d(p), 1), 1e-6);
  EXPECT_GT(closest_pair(more), 0.08f);
}

TEST(Anchors, LieOnTheSurfaceWhereThereIsNoVolume) {
  for (const V3& p : anchors_of(shapes::sheet(1, 1, 2), {.places = AnchorPlaces::volume, .count = 9}))
    EXPECT_EQ(p.z, 0);
}

TEST(Anchors, AreRefusedWhereTheyMakeNoSense) {
  const assets::Model m = shapes::box({1, 1, 1});
  EXPECT_THROW(anchors_of(m, {.places = AnchorPlaces::given}), Error);
  EXPECT_THROW(anchors_of(m, {.places = AnchorPlaces::given, .given = {V3(0, 1 / 0.0f, 0)}}), Error);
  EXPECT_THROW(anchors_of(m, {.places = AnchorPlaces::volume, .count = 0}), Error);
  EXPECT_THROW(anchors_of(m, {.places = AnchorPlaces::surface, .count = 257}), Error);
}

TEST(MakeDetail, KeepsGivenSpheresAndMeasuresThem) {
  const Detail d = make_detail("ball", shapes::icosphere(1, 4), {}, {}, {{V3(0, 0, 0), 1.25f}});
  ASSERT_EQ(d.spheres.size(), 1u);
  EXPECT_NEAR(d.error.outside_m, 0.25f, 0.01f);
  EXPECT_NEAR(d.error.mean_m, 0.25f, 0.01f);
  EXPECT_EQ(d.error.uncovered_m, 0);
  EXPECT_EQ(d.name, "ball");
  EXPECT_EQ(make_detail("ball", shapes::icosphere(1, 3), {}, {}).spheres.size(), 1u);
  EXPECT_THROW(make_detail("ball", shapes::icosphere(1, 1), {}, {}, {{V3(0, 0, 0), 0}}), Error);
}

}  // namespace
