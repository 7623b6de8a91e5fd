// Tufts of grass and sedge: bent blades from one foot.
#include <algorithm>
#include <cmath>

#include "assets/grown/strip.h"
#include "ghosttile/objects/made/parts.h"

namespace ghosttile::objects::made {

namespace {

// A blade: pale at its foot, fine lines along it, dry at its tip.
assets::grown::Canvas paint(const Rgb& colour, const Rgb& dry, float dry_share, std::uint64_t seed) {
  constexpr int width = 32, height = 128;
  assets::grown::Canvas canvas(width, height);
  const auto salt = static_cast<std::uint32_t>(seed * 37 + 5);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float u = (static_cast<float>(x) + 0.5f) / width, v = (static_cast<float>(y) + 0.5f) / height;
      const float line = assets::grown::tiling_noise(u * 9, v * 2, 9, 2, salt);
      const float rib = smooth(0.10f, 0.02f, std::abs(u - 0.5f));
      const float patch = rough(u, v, 2, 6, salt + 3);
      Rgb c =
          mix(colour, dry, clamp01(dry_share + 0.5f * smooth(0.25f, 0.0f, v) * dry_share + 0.25f * patch * dry_share));
      c = mix(c, Rgb(0.20f, 0.19f, 0.10f), 0.55f * smooth(0.75f, 1.0f, v));
      canvas.at(x, y).colour = c * (1 + 0.15f * line + 0.15f * patch + 0.18f * rib);
    }
  }
  return canvas;
}

}  // namespace

Model make_tuft(const MadeOptions& options) {
  const bool sedge = options.form == "sedge";
  Draws draws(options.seed, 0);
  Model model;
  const float dry = options.season == Season::summer ? 0.08f : options.season == Season::autumn ? 0.45f : 0.9f;
  const Rgb green = options.colour.value_or(sedge ? Rgb(0.058f, 0.115f, 0.035f) : Rgb(0.072f, 0.145f, 0.034f));
  const int texture = add_texture(
      model, paint(green, Rgb(0.27f, 0.205f, 0.095f), options.colour ? 0 : dry, options.seed), "blade", false);
  std::uint16_t first = 0;
  for (int s = 0; s < 3; ++s) {
    const float bright = 0.75f + 0.25f * static_cast<float>(s);
    const std::uint16_t m =
        add_material(model, "blade" + std::to_string(s + 1),
                     Rgb(bright * (0.92f + 0.1f * static_cast<float>(s)), bright, 0.95f * bright), texture);
    if (s == 0) first = m;
    const Rgb& c = model.materials[m].reflectance;
    model.materials[m].transmittance = Rgb(0.6f * c.x, 0.9f * c.y, 0.4f * c.z) * (1 - 0.4f * dry);
  }

  // Unit height. Inner blades are long and upright, outer ones short and flat.
  const int blades = sedge ? 46 : 34 + static_cast<int>(draws.share() * 14);
  const float foot_radius = sedge ? 0.07f : 0.10f, thin = sedge ? 0.0085f : 0.015f;
  std::vector<assets::grown::Rib> ribs(4);
  for (int b = 0; b < blades; ++b) {
    const float outer = std::sqrt((static_cast<float>(b) + draws.share()) / static_cast<float>(blades));
    const SinCos around = sin_cos(2 * pi * draws.share());
    const V3 out(around.cos, around.sin, 0);
    const SinCos spread = sin_cos(draws.bell() * 0.5f);
    const V3 lean_way = assets::grown::unit(out * spread.cos + V3(-out.y, out.x, 0) * spread.sin);
    float lean = mix(0.05f, sedge ? 0.40f : 0.65f, outer) * draws.between(0.6f, 1.2f);
    const float bend = (sedge ? 1.0f : 0.9f) * draws.between(0.5f, 1.3f) * (0.5f + 0.5f * outer);
    const float length = mix(1.05f, 0.55f, outer * outer) * draws.between(0.65f, 1.1f) * (sedge ? 1.2f : 1.0f);
    V3 at = out * (foot_radius * outer * draws.between(0.6f, 1.1f));
    const float twist = draws.around(0, 0.7f);
    for (std::size_t r = 0; r < ribs.size(); ++r) {
      static constexpr float shares[] = {0, 0.34f, 0.70f, 1}, widths[] = {0.75f, 1, 0.72f, 0};
      const SinCos up = sin_cos(lean);
      const V3 way = V3(0, 0, 1) * up.cos + lean_way * up.sin;
      const SinCos t = sin_cos(twist * shares[r]);
      const V3 side = V3(0, 0, 1).cross(lean_way);
      const V3 across = side * t.cos + side.cross(way) * t.sin;
      ribs[r].middle = at;
      ribs[r].across = across;
      ribs[r].normal = assets::grown::unit(across.cross(way));
      ribs[r].half_width = widths[r] * thin * draws.between(0.85f, 1.15f) * (0.7f + 0.3f * length);
      ribs[r].v = 1 - shares[r];
      if (r + 1 < ribs.size()) {
        lean += bend * (shares[r + 1] - shares[r]) * (0.5f + shares[r + 1]);
        const SinCos next = sin_cos(std::min(lean, 2.6f));
        at += (V3(0, 0, 1) * next.cos + lean_way * next.sin) * (length * (shares[r + 1] - shares[r]));
        at.z = std::max(at.z, 0.01f);
      }
    }
    assets::grown::Ribbon ribbon;
    ribbon.material = static_cast<std::uint16_t>(first + static_cast<int>(draws.share() * 3));
    assets::grown::add_ribbon(model, ribs, ribbon);
  }
  smooth_normals(model);
  return model;
}

}  // namespace ghosttile::objects::made
