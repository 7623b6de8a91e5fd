// Cones of conifers: one closed surface whose scales are bumps on a lattice, every other row turned by half a scale.
#include <algorithm>
#include <cmath>

#include "ghosttile/objects/made/parts.h"

namespace ghosttile::objects::made {

Model make_cone(const MadeOptions& options) {
  const bool pine = options.form == "pine-cone";
  Draws draws(options.seed, 0);
  Model model;
  const int columns = 12, rows = pine ? 11 : 15;
  const Rgb colour = options.colour.value_or((pine ? Rgb(0.125f, 0.082f, 0.052f) : Rgb(0.165f, 0.095f, 0.052f)) *
                                             draws.between(0.85f, 1.2f));

  // A scale's tip is light, its root dark.
  constexpr int size = 128;
  assets::grown::Canvas canvas(size, size);
  const auto salt = static_cast<std::uint32_t>(options.seed * 43 + 11);
  const auto nearest_tip = [&](float u, float v) {
    // Distance to the nearest bump of the lattice, in cells.
    const float x = u * static_cast<float>(columns), y = v * static_cast<float>(rows - 1);
    float least = 9;
    for (int r = static_cast<int>(y) - 1; r <= static_cast<int>(y) + 2; ++r) {
      const float shift = (r & 1) != 0 ? 1.0f : 0.0f;
      const float k = 2 * std::floor((x - shift) / 2 + 0.5f) + shift;
      const float dx = (x - k) * 0.75f, dy = y - static_cast<float>(r);
      least = std::min(least, std::sqrt(dx * dx + dy * dy));
    }
    return least;
  };
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const float u = (static_cast<float>(x) + 0.5f) / size, v = (static_cast<float>(y) + 0.5f) / size;
      const float d = nearest_tip(u, v);
      Rgb c = mix(colour * 1.5f + Rgb(0.02f, 0.015f, 0.008f), colour * 0.35f, smooth(0.25f, 0.8f, d));
      canvas.at(x, y).colour = c * (1 + 0.25f * rough(u, v, 12, 12, salt));
    }
  }
  const int texture = add_texture(model, std::move(canvas), "cone", false);
  Rings g;
  g.material = g.cap_material = add_material(model, options.form, Rgb(1, 1, 1), texture);
  const float thick = pine ? draws.between(0.30f, 0.36f) : draws.between(0.125f, 0.15f);
  const float bow = pine ? draws.around(0, 0.02f) : draws.around(0, 0.06f);
  const float open = pine ? 0.15f : 0.12f;
  for (int r = 0; r < rows; ++r) {
    const float s = static_cast<float>(r) / static_cast<float>(rows - 1);
    // Widest at a third, rounded at the foot, narrower at the tip.
    const float profile =
        pine ? assets::grown::power(sin_cos(pi * assets::grown::power(mix(0.07f, 0.96f, s), 0.70f)).sin, 0.75f)
             : assets::grown::power(sin_cos(pi * mix(0.08f, 0.95f, s)).sin, 0.45f);
    std::vector<V3> ring;
    for (int k = 0; k < columns; ++k) {
      const bool tip = ((r + k) & 1) == 0;
      const float radius = thick * profile * (tip ? 1 + open * draws.between(0.7f, 1.2f) : 1 - open);
      const SinCos a = sin_cos(2 * pi * static_cast<float>(k) / static_cast<float>(columns));
      // Tips stand a little toward the cone's end. Around x, anticlockwise seen from its tip.
      const float x = s + (tip ? 0.25f : -0.1f) / static_cast<float>(rows);
      ring.push_back({x, bow * 4 * s * (1 - s) + radius * a.cos, radius * a.sin});
    }
    g.rings.push_back(std::move(ring));
    g.v.push_back(s);
  }
  g.foot = V3(-0.03f, 0, 0);
  g.tip = V3(1.05f, 0, 0);
  add_rings(model, g);
  return model;
}

}  // namespace ghosttile::objects::made
