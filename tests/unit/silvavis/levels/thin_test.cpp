#include "silvavis/levels/thin.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "assets/grown/grow.h"
#include "silvavis/levels/silhouette.h"

namespace silvavis::levels {

namespace {

assets::Model square(float side, float height) {
  assets::Model model;
  model.positions = {{0, 0, height}, {side, 0, height}, {side, side, height}, {0, side, height}};
  model.normals.assign(4, V3(0, 0, 1));
  model.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  model.triangles = {{0, 1, 2}, {0, 2, 3}};
  model.triangle_materials = {0, 0};
  model.materials.resize(1);
  return model;
}

}  // namespace

TEST(Silhouette, OfASquareIsItsAreaAndItsShadow) {
  const assets::Model model = square(3, 1);
  EXPECT_NEAR(covered_area(model, V3(0, 0, -1), 0.01f), 9, 0.05);
  const V3 slanted = V3(1, 0, -1).normalized();
  EXPECT_NEAR(covered_area(model, slanted, 0.01f), 9 / std::numbers::sqrt2, 0.05);
  EXPECT_NEAR(covered_area(model, V3(1, 0, 0), 0.01f), 0, 0.05);
}

TEST(Silhouette, LeavesHolesOut) {
  assets::Model model = square(2, 0);
  assets::Texture texture;
  texture.width = texture.height = 4;
  texture.has_alpha = true;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x)
      texture.rgba.insert(texture.rgba.end(), {9, 9, 9, static_cast<std::uint8_t>(x < 1 ? 0 : 255)});
  model.textures.push_back(texture);
  model.materials[0].texture = 0;
  model.materials[0].alpha_cutoff = 0.5f;
  EXPECT_NEAR(covered_area(model, V3(0, 0, -1), 0.01f), 3, 0.03);
}

TEST(Thinned, KeepsWhatTheCrownCovers) {
  for (const char* name :
       {"Fagus sylvatica", "Picea abies", "Betula pendula", "Pinus sylvestris", "Corylus avellana"}) {
    const assets::Model model = assets::grown::grow(assets::grown::form_of(name, 24, 4), 24, 4, 5, {40000});
    const V3 views[] = {V3(0.8f, 0.6f, 0), V3(0, -1, -0.5f).normalized(), V3(0.1f, 0, -1).normalized()};
    for (const double share : {1.0 / 8, 1.0 / 64}) {
      const Thinned simpler = thinned(model, share);
      EXPECT_LT(simpler.model.triangles.size(), static_cast<std::size_t>(40000 * share * 1.5 + 60)) << name;
      EXPECT_GT(simpler.enlarged, 1.2f) << name;
      // Other views than those it was fitted to.
      double before = 0, after = 0;
      for (const V3& view : views) {
        before += covered_area(model, view, 0.05f);
        after += covered_area(simpler.model, view, 0.05f);
      }
      EXPECT_NEAR(after / before, 1, share > 0.1 ? 0.04 : 0.09) << name << " share " << share;
    }
  }
}

TEST(Thinned, IsTheSameTwice) {
  const assets::Model model = assets::grown::grow(assets::grown::form_of("Quercus robur", 20, 5), 20, 5, 2, {10000});
  const assets::Model a = thinned(model, 0.1).model, b = thinned(model, 0.1).model;
  ASSERT_EQ(a.triangles, b.triangles);
  for (std::size_t i = 0; i < a.positions.size(); ++i) ASSERT_EQ(a.positions[i], b.positions[i]);
}

}  // namespace silvavis::levels
