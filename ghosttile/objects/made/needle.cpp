// Needles: thin, closed, bent spindles of few triangles.
#include "ghosttile/objects/made/parts.h"

namespace ghosttile::objects::made {

namespace {

// From foot to tip, thickest in the middle, which stands off the straight line by `bend`.
void add_spindle(Model& model, const V3& foot, const V3& tip, const V3& bend, float radius, int rings,
                 std::uint16_t material) {
  Rings g;
  g.material = g.cap_material = material;
  g.foot = foot;
  g.tip = tip;
  const V3 along = assets::grown::unit(tip - foot), side = assets::grown::beside(V3(0, 0, 1), along),
           other = along.cross(side);
  for (int r = 0; r < rings; ++r) {
    const float share = rings == 1 ? 0.5f : mix(0.12f, 0.72f, static_cast<float>(r) / static_cast<float>(rings - 1));
    std::vector<V3> ring;
    for (int k = 0; k < 3; ++k) {
      const SinCos a = sin_cos(2 * pi * static_cast<float>(k) / 3);
      ring.push_back(mix(foot, tip, share) + bend * (4 * share * (1 - share)) +
                     (side * a.cos + other * a.sin) * radius);
    }
    g.rings.push_back(std::move(ring));
    g.v.push_back(share);
  }
  add_rings(model, g);
}

Rgb colour_of(Season season, Draws& draws) {
  const float turn = draws.share();
  if (season == Season::summer) return mix(Rgb(0.035f, 0.075f, 0.028f), Rgb(0.06f, 0.11f, 0.035f), turn);
  if (season == Season::autumn) return mix(Rgb(0.225f, 0.115f, 0.042f), Rgb(0.15f, 0.075f, 0.034f), turn);
  return mix(Rgb(0.115f, 0.065f, 0.036f), Rgb(0.075f, 0.05f, 0.034f), turn);
}

}  // namespace

Model make_needle(const MadeOptions& options) {
  Draws draws(options.seed, 0);
  Model model;
  const Rgb colour = colour_of(options.season, draws);
  const std::uint16_t material = add_material(model, "needle", options.colour.value_or(colour), assets::no_texture);
  if (options.form == "spruce-needle") {
    add_spindle(model, {0, 0, 0}, {1, 0, 0}, {0, draws.around(0, 0.09f), draws.around(0, 0.03f)}, 0.036f, 2, material);
    return model;
  }
  // Two that part from one foot.
  const float gap = draws.between(0.04f, 0.15f);
  for (const float side : {-1.0f, 1.0f}) {
    const V3 tip(draws.between(0.93f, 1.0f), side * gap, draws.around(0, 0.05f));
    add_spindle(model, {0, 0, 0}, tip, {0, draws.around(0.12f * side * gap, 0.015f), draws.around(0, 0.03f)}, 0.0135f,
                1, material);
  }
  return model;
}

}  // namespace ghosttile::objects::made
