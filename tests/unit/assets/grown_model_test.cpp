// What grow.h promises of every plant: over all forms, seeds, details and sizes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>
#include <thread>

#include "grown_support.h"
#include "silvasim/base/error.h"

namespace assets::grown_tests {
namespace {

using grown::Detail;

void expect_valid(const Model& model) {
  ASSERT_FALSE(model.triangles.empty());
  ASSERT_EQ(model.normals.size(), model.positions.size());
  ASSERT_EQ(model.uvs.size(), model.positions.size());
  ASSERT_EQ(model.triangle_materials.size(), model.triangles.size());
  ASSERT_FALSE(model.materials.empty());
  for (std::size_t i = 0; i < model.positions.size(); ++i) {
    const V3 &p = model.positions[i], &n = model.normals[i];
    ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) << "vertex " << i;
    ASSERT_TRUE(std::isfinite(model.uvs[i].x) && std::isfinite(model.uvs[i].y)) << "vertex " << i;
    ASSERT_NEAR(std::hypot(n.x, n.y, n.z), 1, 1e-4) << "vertex " << i;
  }
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    ASSERT_LT(model.triangle_materials[t], model.materials.size());
    std::array<V3d, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_LT(model.triangles[t][k], model.positions.size());
      corner[k] = V3d(model.positions[model.triangles[t][k]]);
    }
    ASSERT_GT((corner[1] - corner[0]).cross(corner[2] - corner[0]).length(), 0) << "triangle " << t;
  }
  for (const Material& material : model.materials) {
    ASSERT_LT(material.texture, static_cast<int>(model.textures.size()));
    ASSERT_TRUE(material.alpha_cutoff == 0 || material.texture != no_texture);
  }
  for (const Texture& texture : model.textures) {
    ASSERT_EQ(texture.rgba.size(),
              static_cast<std::size_t>(texture.width) * static_cast<std::size_t>(texture.height) * 4);
    bool opaque = true;
    for (std::size_t i = 3; i < texture.rgba.size(); i += 4) opaque = opaque && texture.rgba[i] == 255;
    EXPECT_NE(opaque, texture.has_alpha);
  }
}

void expect_size(const Model& model, const Case& c) {
  const double height_m = c.height_m, radius_m = c.radius_m;
  double highest = 0, widest = 0, lowest = 0;
  std::array<double, 24> sectors{};
  for (const V3& p : model.positions) {
    highest = std::max(highest, static_cast<double>(p.z));
    lowest = std::min(lowest, static_cast<double>(p.z));
    widest = std::max(widest, static_cast<double>(reach(p)));
    auto& sector = sectors[static_cast<std::size_t>((std::atan2(p.y, p.x) / M_PI + 1) * 11.999)];
    sector = std::max(sector, static_cast<double>(reach(p)));
  }
  EXPECT_NEAR(highest, height_m, 0.01 * height_m);
  EXPECT_GE(widest, 0.97 * radius_m);
  EXPECT_LE(widest, 1.001 * radius_m);
  // The crown as a whole fills the radius, no stray twig does.
  std::sort(sectors.begin(), sectors.end());
  EXPECT_GT(sectors[12], 0.8 * radius_m);
  EXPECT_LT(lowest, c.form.habit == grown::Habit::grass ? -0.3 * radius_m : -0.25);
}

void expect_same(const Model& a, const Model& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.uvs, b.uvs);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.triangle_materials, b.triangle_materials);
  EXPECT_EQ(a.materials, b.materials);
  EXPECT_EQ(a.textures, b.textures);
}

TEST(GrownModel, KeepsThePromisesInAllForms) {
  for (const Case& c : cases()) {
    for (const std::uint64_t seed : {1u, 77u}) {
      for (const int triangles : {1000, 5000, 40000}) {
        SCOPED_TRACE(c.form.name + ", seed " + std::to_string(seed) + ", " + std::to_string(triangles));
        const Model model = grown::grow(c.form, c.height_m, c.radius_m, seed, {triangles});
        ASSERT_NO_FATAL_FAILURE(expect_valid(model));
        expect_size(model, c);
        EXPECT_NEAR(static_cast<double>(model.triangles.size()), triangles, 0.15 * triangles);
        EXPECT_EQ(model.name, c.form.name);
      }
    }
  }
}

TEST(GrownModel, KeepsThePromisesWithManyTriangles) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.form.name);
    const Model model = grown::grow(c.form, c.height_m, c.radius_m, 5, Detail::high);
    ASSERT_NO_FATAL_FAILURE(expect_valid(model));
    expect_size(model, c);
    EXPECT_NEAR(static_cast<double>(model.triangles.size()), 160000, 0.15 * 160000);
  }
}

TEST(GrownModel, KeepsThePromisesAtStrangeSizes) {
  std::mt19937 random(20240607);
  std::uniform_real_distribution<double> logarithm(std::log(0.05), std::log(110)), ratio(std::log(0.05), std::log(3));
  const std::vector<grown::Form> forms = grown::all_forms();
  for (int i = 0; i < 120; ++i) {
    const double height_m = std::exp(logarithm(random)), radius_m = height_m * std::exp(ratio(random));
    const grown::Form& form = forms[random() % forms.size()];
    const std::uint64_t seed = random();
    SCOPED_TRACE(form.name + ", " + std::to_string(height_m) + " m high, radius " + std::to_string(radius_m) +
                 " m, seed " + std::to_string(seed));
    const Model model = grown::grow(form, height_m, radius_m, seed, {7000});
    ASSERT_NO_FATAL_FAILURE(expect_valid(model));
    EXPECT_NEAR(static_cast<double>(model.triangles.size()), 7000, 0.15 * 7000);
    double highest = 0, widest = 0;
    for (const V3& p : model.positions) {
      highest = std::max(highest, static_cast<double>(p.z));
      widest = std::max(widest, static_cast<double>(reach(p)));
    }
    EXPECT_NEAR(highest, height_m, 0.01 * height_m);
    EXPECT_NEAR(widest, radius_m, 0.03 * radius_m);
  }
}

TEST(GrownModel, StandsOnItsFootAndReachesBelowTheGround) {
  for (const Case& c : cases()) {
    if (c.form.habit != grown::Habit::woody || c.form.stems > 1) continue;
    SCOPED_TRACE(c.form.name);
    const Model model = grown::grow(c.form, c.height_m, c.radius_m, 3, Detail::high);
    // The ring where the stem leaves the ground, and the lowest one.
    double lowest = 0, radius = 0, below = 0;
    V3d middle(0, 0, 0);
    int count = 0;
    for (const V3& p : model.positions) {
      lowest = std::min(lowest, static_cast<double>(p.z));
      if (std::abs(p.z) < 0.02 && reach(p) < 0.05 * c.height_m) {
        middle += V3d(p);
        radius = std::max(radius, static_cast<double>(reach(p)));
        ++count;
      }
      if (p.z < -0.3) below = std::max(below, static_cast<double>(reach(p)));
    }
    ASSERT_GT(count, 3);
    EXPECT_LT((middle / count).length(), 0.25 * radius);
    EXPECT_NEAR(below, radius, 0.3 * radius);
    EXPECT_NEAR(-lowest, 2 * radius + 0.3, 0.25 * (2 * radius + 0.3));
    EXPECT_GT(radius, 0.5 * c.form.stem_radius_share * c.height_m);
    EXPECT_LT(radius, 3 * c.form.stem_radius_share * c.height_m);
  }
}

TEST(GrownModel, SameArgumentsGiveTheSameBytesOnAnyThread) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.form.name);
    const Model first = grown::grow(c.form, c.height_m, c.radius_m, 9, Detail::least);
    Model second, third;
    std::thread one([&] { second = grown::grow(c.form, c.height_m, c.radius_m, 9, Detail::least); });
    std::thread two([&] { third = grown::grow(c.form, c.height_m, c.radius_m, 9, Detail::least); });
    one.join();
    two.join();
    expect_same(first, second);
    expect_same(first, third);
  }
}

TEST(GrownModel, SeedsGiveDifferentPlants) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.form.name);
    const Model a = grown::grow(c.form, c.height_m, c.radius_m, 1, Detail::medium);
    for (const std::uint64_t seed : {std::uint64_t{2}, std::uint64_t{1} << 40}) {
      const Model b = grown::grow(c.form, c.height_m, c.radius_m, seed, Detail::medium);
      EXPECT_NE(a.positions, b.positions);
      // Not only their bytes: a tenth of what they cover differs.
      const Silhouette x = silhouette(a, c.height_m, c.radius_m, 0, false),
                       y = silhouette(b, c.height_m, c.radius_m, 0, false);
      int differ = 0, either = 0;
      for (std::size_t i = 0; i < x.covered.size(); ++i) {
        differ += x.covered[i] != y.covered[i];
        either += x.covered[i] || y.covered[i];
      }
      EXPECT_GT(differ, either / 10);
    }
  }
}

TEST(GrownModel, ColoursArePhysical) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.form.name);
    const Model model = grown::grow(c.form, c.height_m, c.radius_m, 1, Detail::medium);
    for (const Material& material : model.materials) {
      SCOPED_TRACE(material.name);
      const Seen mean = seen(model, material);
      const bool leaf = material.name.starts_with("leaf") || material.name.starts_with("blade");
      if (leaf) {
        EXPECT_GT(mean.green, 0.035);
        EXPECT_LT(mean.green, 0.21);
        EXPECT_GT(mean.green, mean.red * 0.99);
        EXPECT_GT(mean.red, mean.blue);
        EXPECT_GT(mean.red, 0.015);
        EXPECT_LT(mean.red, 0.18);
        // What passes is less than what comes back, and yellower.
        EXPECT_GT(material.transmittance.y, 0);
        EXPECT_LE(material.transmittance.y, material.reflectance.y);
        EXPECT_LT(material.transmittance.z / material.reflectance.z, material.transmittance.x / material.reflectance.x);
        EXPECT_TRUE(material.two_sided);
      } else if (material.name.find("bark") != std::string::npos) {
        const double brightness = 0.2126 * mean.red + 0.7152 * mean.green + 0.0722 * mean.blue;
        EXPECT_GT(brightness, 0.08);
        EXPECT_LT(brightness, 0.6);
        EXPECT_EQ(material.transmittance, Rgb(0, 0, 0));
      }
    }
  }
}

TEST(GrownModel, HasTheLeafAreaOfItsForm) {
  for (const Case& c : cases()) {
    if (c.form.habit != grown::Habit::woody) continue;
    SCOPED_TRACE(c.form.name);
    const Model model = grown::grow(c.form, c.height_m, c.radius_m, 1, Detail::high);
    double area = 0;
    for (std::size_t t = 0; t < model.triangles.size(); ++t) {
      const Material& material = model.materials[model.triangle_materials[t]];
      if (!material.name.starts_with("leaf")) continue;
      const auto& [a, b, d] = model.triangles[t];
      const V3d p(model.positions[a]), q(model.positions[b]), r(model.positions[d]);
      area += 0.5 * (q - p).cross(r - p).length();
    }
    for (const Material& material : model.materials)
      if (material.name == "leaf1") area *= seen(model, material).opaque;
    const double ground = M_PI * c.radius_m * c.radius_m;
    const double slenderness = (1 - c.form.crown_base) * c.height_m / (2 * c.radius_m);
    const double wanted = c.form.leaf_area_index * ground * std::sqrt(std::max(1.0, slenderness / 2));
    EXPECT_NEAR(area, wanted, 0.3 * wanted);  // the crown is stretched to its radius after the leaves are sized
  }
}

TEST(GrownModel, RefusesWhatIsNoPlant) {
  const grown::Form form = grown::form_of("Fagus sylvatica", 30, 5);
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -1.0, nan, infinite, -infinite, 1e9}) {
    EXPECT_THROW(grown::grow(form, bad, 5, 1, Detail::least), silvasim::base::Error) << bad;
    EXPECT_THROW(grown::grow(form, 30, bad, 1, Detail::least), silvasim::base::Error) << bad;
  }
  for (const int bad : {-5, 0, 999, 20000001, std::numeric_limits<int>::max()})
    EXPECT_THROW(grown::grow(form, 30, 5, 1, {bad}), silvasim::base::Error) << bad;
  try {
    grown::grow(form, 30, -2, 1, Detail::least);
    FAIL();
  } catch (const silvasim::base::Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("-2 m radius"));
  }
}

#if defined(NDEBUG) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(GrownModel, GrowsFast) {
  for (const auto& [detail, most_s] : {std::pair{Detail::high, 1.0}, {Detail::medium, 0.5}}) {
    double best = 100;
    for (int i = 0; i < 3; ++i) {
      const auto start = std::chrono::steady_clock::now();
      grown::grow(grown::form_of("Fagus sylvatica", 32, 4.5), 32, 4.5, 1, detail);
      best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    EXPECT_LT(best, most_s);
  }
}
#endif

}  // namespace
}  // namespace assets::grown_tests
