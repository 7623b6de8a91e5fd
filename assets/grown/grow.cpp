#include "assets/grown/grow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assets/grown/flowers.h"
#include "assets/grown/foliage.h"
#include "assets/grown/low.h"
#include "assets/grown/paint.h"
#include "assets/grown/reach.h"
#include "assets/grown/skeleton.h"
#include "assets/grown/wood.h"
#include "silvasim/base/error.h"

namespace assets::grown {

namespace {

// Share of the triangles that the wood may have.
float wood_share(const Form& form, std::size_t triangles) {
  const float fine = clamp01((static_cast<float>(triangles) - 5000) / 155000);
  return mix(0.2f, 0.32f, std::sqrt(fine)) * (form.stems > 1 ? 1.2f : 1.0f);
}

// A crown that is long for its width has more layers of leaves.
float leaf_area(const Form& form, float height, float radius, std::size_t triangles) {
  const float few = clamp01(silvasim::base::log(160000.0f / static_cast<float>(triangles)) / 3.4657f);  // ln 32
  const float slenderness = (1 - form.crown_base) * height / (2 * radius);
  return form.leaf_area_index * pi * radius * radius * power(std::max(1.0f, slenderness / 2), 0.5f) *
         mix(1.0f, form.few_cards_area, few);
}

void add_bark(Model& model, const Rgb& colour, Bark bark, const char* name, std::uint64_t seed) {
  Material material;
  material.name = name;
  material.reflectance = Rgb(1, 1, 1);
  material.two_sided = false;
  material.texture = static_cast<int>(model.textures.size());
  model.textures.push_back(paint_bark(bark, colour, seed));
  model.textures.back().name = name;
  model.materials.push_back(material);
}

void add_woody(Model& model, const Form& form, float height, float radius, std::uint64_t seed, std::size_t triangles) {
  const Skeleton skeleton = grow_skeleton(form, height, radius, seed);
  BarkMaterials bark;
  add_bark(model, form.bark_colour, form.bark, "bark", seed);
  if (form.bark_upper_share < 1) {
    add_bark(model, form.bark_upper_colour, form.bark, "upper bark", seed);
    bark.upper = static_cast<std::uint16_t>(model.materials.size() - 1);
    bark.upper_from_m = form.bark_upper_share * height;
  }
  Material twig;
  twig.name = "twig";
  twig.reflectance = form.twig_colour;
  twig.two_sided = false;
  bark.twig = static_cast<std::uint16_t>(model.materials.size());
  model.materials.push_back(twig);
  const float share = wood_share(form, triangles);
  const std::size_t used =
      add_wood(model, skeleton, bark, static_cast<std::size_t>(share * static_cast<float>(triangles))) +
      add_flowers(model, skeleton, form, height, seed);
  FoliageBudget budget;
  budget.triangles = triangles - std::min(triangles, used);
  budget.leaf_area_m2 = leaf_area(form, height, radius, triangles);
  add_foliage(model, skeleton, form, height, seed, budget);
}

}  // namespace

Model grow(const Form& form, double height_m, double radius_m, std::uint64_t seed, Detail detail) {
  const auto good = [](double x) { return x > 0 && x < 1000; };
  if (!good(height_m) || !good(radius_m))
    throw silvasim::base::Error(
        fmt::format("a plant of {} m height and {} m radius cannot be grown; both must be above 0 and below 1000",
                    height_m, radius_m));
  if (detail.triangles < 1000 || detail.triangles > 20'000'000)
    throw silvasim::base::Error(
        fmt::format("a plant of {} triangles cannot be grown; 1000 to 20000000 are possible", detail.triangles));
  const auto height = static_cast<float>(height_m), radius = static_cast<float>(radius_m);
  Model model;
  model.name = form.name;
  const auto target = static_cast<std::size_t>(detail.triangles);
  if (form.habit == Habit::fern) {
    add_fern(model, form, height, radius, seed, target);
  } else if (form.habit == Habit::grass) {
    add_grass(model, form, height, radius, seed, target);
  } else {
    add_woody(model, form, height, radius, seed, target);
  }
  fit_points(model.positions, height, radius);
  return model;
}

}  // namespace assets::grown
