#include <algorithm>
#include <vector>

#include "assets/grown/low.h"
#include "assets/grown/paint.h"
#include "assets/grown/strip.h"

namespace assets::grown {

namespace {

constexpr float least_width_m = 0.0022f;  // blades are not drawn thinner; they have more joints instead
constexpr float stalk_share = 0.03f;      // of the shoots that flower
constexpr int shades = 3;

// A blade leaves the foot steeply and bends over under its weight. `way` gives the middle, `ribs` pieces.
std::vector<Rib> shape_blade(const V3& foot, const V3& out, float length, float lean, float bend, float half,
                             int pieces) {
  std::vector<Rib> ribs;
  V3 p = foot;
  const V3 across(-out.y, out.x, 0);
  float angle = lean;
  const float step = length / static_cast<float>(pieces);
  for (int i = 0; i <= pieces; ++i) {
    const float s = static_cast<float>(i) / static_cast<float>(pieces);
    const SinCos a = sin_cos(std::min(angle, 2.6f));
    const V3 way = out * a.sin + V3(0, 0, a.cos);
    Rib rib;
    rib.middle = p;
    rib.across = across;
    rib.normal = unit(across.cross(way));
    rib.half_width = i == pieces ? 0 : half * (1 - 0.75f * s * s) * (s < 0.1f ? 0.7f + 3 * s : 1);
    rib.v = s;
    ribs.push_back(rib);
    p += way * step;
    angle += bend * 2 * (s + 0.5f / static_cast<float>(pieces)) / static_cast<float>(pieces);
  }
  return ribs;
}

}  // namespace

void add_grass(Model& model, const Form& form, float height_m, float radius_m, std::uint64_t seed,
               std::size_t triangles) {
  for (int s = 0; s < shades; ++s) {
    // Young blades are green, old ones straw-coloured.
    Material material;
    material.name = "blade" + std::to_string(s + 1);
    const float old = s == 2 ? 0.55f : 0.15f * static_cast<float>(s);
    material.reflectance = mix(form.leaf_colour, Rgb(0.20f, 0.16f, 0.075f), old);
    material.transmittance =
        Rgb(material.reflectance.x * form.leaf_passes.x, material.reflectance.y * form.leaf_passes.y,
            material.reflectance.z * form.leaf_passes.z);
    model.materials.push_back(material);
  }
  Material stalk;
  stalk.name = "stalk";
  stalk.reflectance = Rgb(0.24f, 0.185f, 0.10f);
  model.materials.push_back(stalk);

  const float usual_length = std::min(1.05f * height_m, 0.8f * height_m + 0.5f * radius_m);
  const float area = form.leaf_area_index * pi * radius_m * radius_m;
  const float most = area / (usual_length * least_width_m * 0.75f);
  int pieces = 3;
  while (static_cast<float>(triangles) / static_cast<float>(2 * pieces - 1) > most && pieces < 200) ++pieces;
  const std::size_t blades = std::max<std::size_t>(8, triangles / static_cast<std::size_t>(2 * pieces - 1));
  const float half = 0.5f * area / (static_cast<float>(blades) * usual_length * 0.75f);
  for (std::size_t i = 0; i < blades; ++i) {
    Draws draws(seed, 6, static_cast<std::uint32_t>(i));
    const SinCos place = sin_cos(2 * pi * draws.share());
    const float off = 0.28f * radius_m * std::sqrt(draws.share());
    const V3 foot(off * place.cos, off * place.sin, -0.02f * height_m);
    // Blades lean away from the middle, more or less.
    const SinCos turn = sin_cos(draws.around(0, 1.1f));
    const V3 out =
        unit(V3(place.cos * turn.cos - place.sin * turn.sin, place.sin * turn.cos + place.cos * turn.sin, 0));
    const bool flowers = draws.share() < stalk_share;
    const float length = usual_length * (flowers ? draws.between(0.9f, 1.0f) : draws.between(0.45f, 1.0f));
    const float lean = flowers ? draws.between(0.02f, 0.22f) : draws.between(0.05f, 0.5f);
    const float bend = flowers ? draws.between(0.05f, 0.25f) : draws.between(0.4f, 1.9f);
    std::vector<Rib> ribs = shape_blade(foot, out, length, lean, bend, half * draws.between(0.7f, 1.3f), pieces);
    ribs.front().middle.z -= 0.3f * radius_m + 0.03f;  // on a slope, too, all begin below the ground
    Ribbon ribbon;
    if (flowers) {
      // A stalk is thin below, its panicle stands at the upper fifth.
      for (std::size_t r = 0; r + 1 < ribs.size(); ++r) {
        const float s = ribs[r].v;
        ribs[r].half_width = s < 0.7f ? 0.35f * half : std::max(1.6f * half, 0.004f) * (1.05f - s) / 0.3f;
      }
      ribbon.material = shades;
    } else {
      const float age = draws.share();
      ribbon.material = age < 0.45f ? 0 : age < 0.88f ? 1 : 2;
    }
    add_ribbon(model, ribs, ribbon);
  }
}

}  // namespace assets::grown
