#include "ghosttile/objects/sphere_fit.h"

#include <Imath/ImathMatrix.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "ghosttile/objects/surface.h"
#include "shapes.h"
#include "silvasim/base/error.h"

namespace {

using namespace ghosttile::objects;
using silvasim::base::Error;

bool held(const std::vector<Sphere>& spheres, const V3& p, float slack = 0) {
  for (const Sphere& s : spheres) {
    if ((p - s.centre).length() <= s.radius_m + slack) return true;
  }
  return false;
}

// Volume of a union of spheres, by trying places.
double union_volume(const std::vector<Sphere>& spheres, const V3& half, int tries) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> draw(-1, 1);
  int hits = 0;
  for (int i = 0; i < tries; ++i) hits += held(spheres, V3(draw(random), draw(random), draw(random)) * half);
  return 8.0 * static_cast<double>(half.x * half.y * half.z) * hits / tries;
}

assets::Model turned(assets::Model m, const Imath::M44f& by) {
  for (V3& p : m.positions) by.multVecMatrix(p, p);
  return m;
}

TEST(Surface, TellsInsideFromOutsideAsTheFormulaDoes) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> draw(-1.2, 1.2);
  const assets::Model m = shapes::box({2, 1.5f, 1});
  const Surface s = surface_of(m);
  EXPECT_NEAR(s.volume_m3, 3, 1e-6);
  for (int i = 0; i < 20000; ++i) {
    V3d p(draw(random), draw(random), draw(random));
    if (i % 3 == 0) p.x = 0;  // on the diagonals' crossing and along edges of the triangulation
    if (i % 5 == 0) p.y = 0.75 * p.x;
    const bool in = std::abs(p.x) < 1 && std::abs(p.y) < 0.75 && std::abs(p.z) < 0.5;
    ASSERT_EQ(inside(s, p), in) << p;
    const V3d out(std::max(0.0, std::abs(p.x) - 1), std::max(0.0, std::abs(p.y) - 0.75),
                  std::max(0.0, std::abs(p.z) - 0.5));
    const double far = in ? std::min({1 - std::abs(p.x), 0.75 - std::abs(p.y), 0.5 - std::abs(p.z)}) : out.length();
    ASSERT_NEAR(distance_m(s, p, 10), far, 1e-9);
  }
}

TEST(Surface, FindsWhatIsBuriedAndWhatIsTurnedInsideOut) {
  assets::Model m = shapes::joined(shapes::icosphere(1, 2), shapes::icosphere(0.3f, 1), {0.1f, 0, 0});
  for (auto& t : m.triangles) std::swap(t[0], t[1]);
  const Surface s = surface_of(m);
  std::size_t buried = 0;
  for (const auto b : s.buried) buried += b;
  EXPECT_EQ(buried, 80u);
  for (std::size_t t = 0; t < s.corners.size(); ++t) EXPECT_TRUE(s.buried[t] || s.normals[t].dot(s.middle[t]) > 0);
}

TEST(SphereFit, FindsTheSphereInASphere) {
  const assets::Model m = shapes::icosphere(0.25f, 3);
  const SphereFit fit = fit_spheres(m);
  ASSERT_EQ(fit.spheres.size(), 1u);
  EXPECT_NEAR(fit.spheres[0].radius_m, 0.25f, 0.0025f);
  EXPECT_LT(fit.spheres[0].centre.length(), 0.0025f);
  EXPECT_LT(fit.error.uncovered_m, 0.0025f);
  EXPECT_LT(fit.error.outside_m, 0.005f);
}

TEST(SphereFit, NeverReachesOutFartherThanAllowed) {
  for (const float share : {0.0f, 0.05f, 0.2f}) {
    for (const V3& size : {V3(1, 1, 1), V3(2, 1, 0.5f), V3(4, 0.3f, 0.3f)}) {
      const assets::Model m = shapes::box(size);
      const SphereFit fit = fit_spheres(m, {.spheres = 32, .outside_share = share});
      double largest = 0;
      for (const Sphere& s : fit.spheres) {
        const V3 c = s.centre;
        const float in =
            std::min({0.5f * size.x - std::abs(c.x), 0.5f * size.y - std::abs(c.y), 0.5f * size.z - std::abs(c.z)});
        ASSERT_GT(in, 0);
        EXPECT_LE(s.radius_m, in * (1 + share) * 1.0001f);
        largest = std::max(largest, static_cast<double>(s.radius_m - in));
      }
      EXPECT_NEAR(fit.error.outside_m, largest, 1e-5);
    }
  }
}

TEST(SphereFit, FillsABoxBetterTheMoreSpheresThereAre) {
  const assets::Model m = shapes::box({2, 1, 0.5f});
  double before = 0, mean = 1;
  for (const int n : {2, 8, 32, 128}) {
    const SphereFit fit = fit_spheres(m, {.spheres = n, .outside_share = 0});
    const double share = union_volume(fit.spheres, {1, 0.5f, 0.25f}, 100000);
    EXPECT_GT(share, before) << n;
    EXPECT_LE(share, 1.0);
    EXPECT_LT(static_cast<double>(fit.error.mean_m), mean) << n;
    before = share;
    mean = static_cast<double>(fit.error.mean_m);
    RecordProperty("filled_by_" + std::to_string(n), std::to_string(share));
  }
  EXPECT_GT(before, 0.85);
}

TEST(SphereFit, SpreadsEvenlyAlongABar) {
  const SphereFit fit = fit_spheres(shapes::box({4, 0.2f, 0.2f}), {.spheres = 20});
  std::vector<float> x;
  for (const Sphere& s : fit.spheres) x.push_back(s.centre.x);
  std::sort(x.begin(), x.end());
  ASSERT_EQ(x.size(), 20u);
  for (std::size_t i = 1; i < x.size(); ++i) EXPECT_LT(x[i] - x[i - 1], 0.33f) << i;
  EXPECT_LT(x.front(), -1.8f);
  EXPECT_GT(x.back(), 1.8f);
}

TEST(SphereFit, TurnsAndGrowsWithTheModel) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> draw(-3, 3);
  const assets::Model m = shapes::joined(shapes::box({1, 0.4f, 0.3f}), shapes::icosphere(0.3f, 2), {0.5f, 0.1f, 0.1f});
  const SphereFit plain = fit_spheres(m, {.spheres = 16, .seed = 9});
  const double volume = union_volume(plain.spheres, {1, 1, 1}, 200000);
  for (int i = 0; i < 4; ++i) {
    Imath::M44f turn;
    turn.setEulerAngles(V3(draw(random), draw(random), draw(random)));
    const SphereFit fit = fit_spheres(turned(m, turn), {.spheres = 16, .seed = 9});
    EXPECT_NEAR(union_volume(fit.spheres, {1, 1, 1}, 200000) / volume, 1, 0.04);
    EXPECT_NEAR(fit.error.mean_m / plain.error.mean_m, 1, 0.15);
    EXPECT_NEAR(fit.error.uncovered_m / plain.error.uncovered_m, 1, 0.35);
  }
  assets::Model large = m;
  for (V3& p : large.positions) p *= 8;
  const SphereFit grown = fit_spheres(large, {.spheres = 16, .seed = 9});
  ASSERT_EQ(grown.spheres.size(), plain.spheres.size());
  for (std::size_t k = 0; k < grown.spheres.size(); ++k) {
    EXPECT_EQ(grown.spheres[k].centre, plain.spheres[k].centre * 8.0f);
    EXPECT_EQ(grown.spheres[k].radius_m, plain.spheres[k].radius_m * 8.0f);
  }
}

TEST(SphereFit, HoldsEveryPointOfAShell) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> draw(-0.5f, 0.5f);
  for (const float bend : {0.0f, 1.5f}) {
    assets::Model m = shapes::sheet(0.06f, 0.1f, 6);
    for (V3& p : m.positions) p.z = bend * 10 * p.x * p.x;
    for (const int n : {1, 6, 24, 100}) {
      const SphereFit fit = fit_spheres(m, {.spheres = n});
      ASSERT_EQ(fit.spheres.size(), static_cast<std::size_t>(n));
      EXPECT_EQ(fit.error.uncovered_m, 0);
      for (const auto& t : m.triangles) {
        for (int i = 0; i < 300; ++i) {
          float u = draw(random) + 0.5f, v = draw(random) + 0.5f;
          if (u + v > 1) u = 1 - u, v = 1 - v;
          const V3 p = m.positions[t[0]] * (1 - u - v) + m.positions[t[1]] * u + m.positions[t[2]] * v;
          ASSERT_TRUE(held(fit.spheres, p, 1e-7f)) << n << " " << p;
        }
      }
      // Not wasteful: the best that discs can do on a plane is area = n * 2.6 r^2.
      if (n >= 24 && bend == 0) {
        const float r = fit.spheres[0].radius_m;
        EXPECT_LT(static_cast<float>(n) * 2.6f * r * r, 2.3f * 0.006f) << n;
      }
    }
  }
}

TEST(SphereFit, KeepsAShellsThicknessWhereItIsGiven) {
  const SphereFit fit = fit_spheres(shapes::sheet(0.06f, 0.1f, 3), {.spheres = 4, .thickness_m = 0.005f});
  for (const Sphere& s : fit.spheres) EXPECT_EQ(s.radius_m, 0.005f);
  EXPECT_EQ(fit.error.uncovered_m, 0);
  EXPECT_LT(fit.spheres.size(), 240u);  // 92 would do on an endless plane
  EXPECT_THROW(fit_spheres(shapes::sheet(0.06f, 0.1f, 3), {.thickness_m = 0.0005f}), Error);
}

TEST(SphereFit, TakesAHoleAndASkinForShells) {
  assets::Model holed = shapes::icosphere(1, 2);
  holed.triangles.erase(holed.triangles.begin() + 7);
  shapes::close(holed);
  const SphereFit fit = fit_spheres(holed, {.spheres = 40});
  EXPECT_EQ(fit.error.uncovered_m, 0);
  EXPECT_LT(fit.spheres[0].radius_m, 0.6f);
  const SphereFit skin = fit_spheres(shapes::box({1, 1, 0.002f}), {.spheres = 24});
  EXPECT_EQ(skin.error.uncovered_m, 0);
  EXPECT_GT(skin.spheres[0].radius_m, 0.1f);
}

TEST(SphereFit, SharesSpheresBetweenAStoneAndItsLeaf) {
  const assets::Model m = shapes::joined(shapes::icosphere(0.1f, 3), shapes::sheet(0.2f, 0.2f, 2), {0, 0, 0.3f});
  const SphereFit fit = fit_spheres(m, {.spheres = 20});
  EXPECT_LE(fit.spheres.size(), 20u);
  EXPECT_GE(fit.spheres.size(), 6u);
  EXPECT_LT(fit.error.uncovered_m, 0.002f);
}

TEST(SphereFit, RefusesBadModelsByName) {
  const auto refused = [](assets::Model m, const std::string& words, const SphereFitOptions& options = {}) {
    try {
      fit_spheres(m, options);
      ADD_FAILURE() << "not refused: " << words;
    } catch (const Error& e) {
      EXPECT_THAT(e.what(), testing::HasSubstr(words));
      EXPECT_THAT(e.what(), testing::HasSubstr("\"" + m.name + "\""));
    }
  };
  assets::Model m = shapes::box({1, 1, 1});
  m.positions[3].y = std::numeric_limits<float>::quiet_NaN();
  refused(m, "not a finite number");
  m = shapes::box({1, 1, 1});
  m.triangles[2][1] = 8;
  refused(m, "corner 8");
  m.triangles.clear();
  refused(m, "no triangle");
  m = shapes::box({1, 0, 0});
  refused(m, "no area");
  m.triangles.resize(1'000'001, {0, 1, 2});
  refused(m, "simplify");
  m = shapes::box({1, 1, 1});
  refused(m, "1 to 1024", {.spheres = 1'000'000});
  refused(m, "1 to 1024", {.spheres = 0});
  refused(m, "0 to 10", {.outside_share = std::numeric_limits<float>::quiet_NaN()});
  refused(m, "not a length", {.thickness_m = -1});
}

TEST(SphereFit, IsTheSameEveryTime) {
  const assets::Model m = shapes::box({2, 1, 0.5f});
  EXPECT_EQ(fit_spheres(m, {.seed = 4}).spheres, fit_spheres(m, {.seed = 4}).spheres);
  EXPECT_NE(fit_spheres(m, {.seed = 4}).spheres, fit_spheres(m, {.seed = 5}).spheres);
}

}  // namespace
