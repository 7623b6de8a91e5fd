#include "assets/fit.h"

#include <gmock/gmock.h>

#include <numbers>

#include "assets/normals.h"
#include "files.h"

namespace assets {
namespace {

using namespace test;
using testing::HasSubstr;

// Appends a disc of `sides` triangles.
void add_disc(Model& m, double x, double y, double z, double radius, int sides = 256) {
  const auto first = static_cast<std::uint32_t>(m.positions.size());
  const auto point = [&](double px, double py) {
    m.positions.emplace_back(static_cast<float>(px), static_cast<float>(py), static_cast<float>(z));
    m.normals.emplace_back(0.0f, 0.0f, 1.0f);
    m.uvs.emplace_back(0.0f, 0.0f);
  };
  point(x, y);
  for (int i = 0; i < sides; ++i) {
    const double a = 2 * std::numbers::pi * i / sides;
    point(x + radius * std::cos(a), y + radius * std::sin(a));
  }
  for (int i = 0; i < sides; ++i) {
    m.triangles.push_back(
        {first, first + 1 + static_cast<std::uint32_t>(i), first + 1 + static_cast<std::uint32_t>((i + 1) % sides)});
    m.triangle_materials.push_back(0);
  }
}

// A stem's foot and a crown, as discs.
Model mushroom(double x, double y, double z, double stem = 0.1, double crown = 2, double height = 10) {
  Model m;
  m.name = "mushroom";
  m.materials.emplace_back();
  add_disc(m, x, y, z, stem);
  add_disc(m, x, y, z + height, crown);
  return m;
}

TEST(Fit, MeasuresADisc) {
  const Measures m = measure(mushroom(0, 0, 0));
  EXPECT_NEAR(m.height_m, 10, 1e-6);
  EXPECT_NEAR(m.reach_m, 2, 1e-5);
  EXPECT_NEAR(m.foot_radius_m, 0.1, 1e-6);
  // Of a disc, 98 % of the area lies within sqrt(0.98) of the radius.
  EXPECT_NEAR(m.crown_radius_m, 2 * std::sqrt(0.98), 0.01);
  EXPECT_EQ(m.triangles, 512u);
}

TEST(Fit, OneLongBranchDoesNotMakeTheCrown) {
  Model m = mushroom(0, 0, 0);
  add_disc(m, 30, 0, 9, 0.02, 3);
  EXPECT_NEAR(measure(m).crown_radius_m, 2, 0.05);
  EXPECT_NEAR(measure(m).reach_m, 30, 0.1);
}

TEST(Fit, FindsTheFootWhereverTheModelStands) {
  for (const auto& [x, y, z] :
       {std::array{0.0, 0.0, 0.0}, std::array{50.0, -20.0, 7.0}, std::array{-3.0, 4.0, -100.0}}) {
    const Model fit = fitted(mushroom(x, y, z), {.height_m = 20, .radius_m = 3});
    const Measures m = measure(fit);
    EXPECT_NEAR(m.least.z, 0, 1e-5);
    EXPECT_NEAR(m.height_m, 20, 1e-4);
    EXPECT_NEAR(m.crown_radius_m, 3, 0.01);
    EXPECT_NEAR(m.least.x + m.greatest.x, 0, 1e-4);
    EXPECT_NEAR(m.least.y + m.greatest.y, 0, 1e-4);
  }
}

TEST(Fit, RootsStayBelowTheGround) {
  Model m = mushroom(0, 0, 0);
  add_disc(m, 0, 0, -1, 0.3);
  const Model fit = fitted(m, {.height_m = 5, .radius_m = 1});
  EXPECT_NEAR(measure(fit).least.z, -0.5, 1e-5);
  EXPECT_NEAR(measure(fit).greatest.z, 5, 1e-5);
  // A model drawn around its middle has no roots.
  EXPECT_NEAR(measure(fitted(mushroom(0, 0, -5), {.height_m = 5, .radius_m = 1})).least.z, 0, 1e-5);
}

TEST(Fit, HolesInLeavesDoNotCount) {
  Model m = mushroom(0, 0, 0);
  Texture texture{"t", 1, 1, true, {0, 0, 0, 0}};
  m.textures.push_back(texture);
  m.materials.push_back({.name = "hole", .texture = 0, .alpha_cutoff = 0.5f});
  const std::size_t before = m.triangles.size();
  add_disc(m, 0, 0, 10, 8);
  for (std::size_t t = before; t < m.triangles.size(); ++t) m.triangle_materials[t] = 1;
  EXPECT_NEAR(measure(m).crown_radius_m, 2, 0.05);
}

TEST(Fit, NormalsKeepToTheSurfaceWhenStretched) {
  const Folder folder;
  const Model slope = load(folder.write("a.obj", "v -1 0 0\nv 1 0 0\nv 1 1 1\nv -1 1 1\nf 1 2 3 4\n"));
  const Model fit = fitted(slope, {.height_m = 5, .radius_m = 1});
  ASSERT_EQ(broken_promise(fit), "");
  for (std::size_t t = 0; t < fit.triangles.size(); ++t) {
    const auto& [a, b, c] = fit.triangles[t];
    const V3 normal = (fit.positions[b] - fit.positions[a]).cross(fit.positions[c] - fit.positions[a]).normalized();
    for (const std::uint32_t corner : {a, b, c}) EXPECT_NEAR(fit.normals[corner].dot(normal), 1, 1e-5);
  }
}

TEST(Fit, WarnsOfStretching) {
  LoadReport report;
  fitted(mushroom(0, 0, 0), {.height_m = 10, .radius_m = 2.8}, &report);
  EXPECT_THAT(report.warnings, testing::IsEmpty());
  fitted(mushroom(0, 0, 0), {.height_m = 10, .radius_m = 3.2}, &report);
  EXPECT_THAT(report.warnings, testing::ElementsAre(testing::AllOf(HasSubstr("1.6"), HasSubstr("wider"))));
  fitted(mushroom(0, 0, 0), {.height_m = 30, .radius_m = 0}, &report);
  EXPECT_EQ(report.warnings.size(), 1u);
}

TEST(Fit, RefusesWhatHasNoMeasures) {
  EXPECT_THROW(fitted(mushroom(0, 0, 0), {.height_m = 0, .radius_m = 1}), silvasim::base::Error);
  EXPECT_THROW(fitted(mushroom(0, 0, 0), {.height_m = NAN, .radius_m = 1}), silvasim::base::Error);
  EXPECT_THROW(fitted(mushroom(0, 0, 0), {.height_m = 5, .radius_m = -1}), silvasim::base::Error);
  Model flat;
  flat.materials.emplace_back();
  add_disc(flat, 0, 0, 0, 1);
  EXPECT_THROW(fitted(flat, {.height_m = 5, .radius_m = 1}), silvasim::base::Error);
}

}  // namespace
}  // namespace assets
