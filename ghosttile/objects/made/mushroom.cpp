// Mushrooms: one closed surface of revolution, stalk, gills and cap, leaning a little, with a painted skin.
#include <algorithm>
#include <array>
#include <cmath>

#include "ghosttile/objects/made/parts.h"

namespace ghosttile::objects::made {

namespace {

constexpr int size = 256, sides = 18;
constexpr float stalk_v = 0.60f, gills_v = 0.45f;  // below is stalk, between the cap's lower side, above (to 0) the cap

struct Profile {
  float radius, height, v;
};

// Unit height, foot to top.
std::vector<Profile> profile_of(bool cep, Draws& draws) {
  const float cap = cep ? draws.between(0.38f, 0.50f) : draws.between(0.42f, 0.55f);
  const float stalk = cep ? draws.between(0.15f, 0.20f) : draws.between(0.07f, 0.085f);
  const float rim = cep ? 0.60f : draws.between(0.70f, 0.76f);
  const float bulb = cep ? 1.35f : 1.7f;
  std::vector<Profile> p{{stalk * bulb * 0.75f, 0.0f, 1.0f},
                         {stalk * bulb, 0.07f, 0.94f},
                         {stalk * 1.08f, 0.25f, 0.82f},
                         {stalk * 0.95f, 0.45f, 0.70f},
                         {stalk * 0.95f, rim - 0.02f, stalk_v}};
  p.push_back({0.62f * cap, rim + (cep ? -0.005f : 0.015f), 0.52f});
  p.push_back({0.95f * cap, rim - 0.02f, gills_v});
  // A half ellipse over the rim.
  for (const float angle : {0.12f, 0.45f, 0.80f, 1.12f, 1.38f}) {
    const SinCos a = sin_cos(angle);
    p.push_back({cap * a.cos, rim + (1 - rim) * a.sin, gills_v * (1 - angle / 1.5708f)});
  }
  return p;
}

assets::grown::Canvas paint(bool cep, const Rgb& cap, std::uint64_t seed) {
  assets::grown::Canvas canvas(size, size);
  const auto salt = static_cast<std::uint32_t>(seed * 89 + 41);
  // White flakes on the red cap, in its plane seen from above.
  Draws draws(seed, 1);
  struct Flake {
    V2 at;
    float radius;
  };
  std::vector<Flake> flakes;
  for (int k = 0; k < 46; ++k) {
    const float r = std::sqrt(draws.share());
    const SinCos a = sin_cos(2 * pi * draws.share());
    flakes.push_back({V2(a.cos, a.sin) * r, draws.between(0.025f, 0.075f)});
  }
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const float u = (static_cast<float>(x) + 0.5f) / size, v = (static_cast<float>(y) + 0.5f) / size;
      const float patch = rough(u, v, 4, 4, salt), fine = rough(u, v, 24, 24, salt + 5);
      Rgb c;
      if (v > stalk_v) {
        const float line = assets::grown::tiling_noise(u * 24, v * 5, 24, 5, salt + 9);
        c = (cep ? Rgb(0.47f, 0.37f, 0.24f) : Rgb(0.62f, 0.58f, 0.47f)) * (1 + 0.12f * line + 0.10f * patch);
        c = mix(c, Rgb(0.16f, 0.12f, 0.08f), 0.6f * smooth(0.93f, 1.0f, v + 0.04f * patch));
      } else if (v > gills_v) {
        const float gill = assets::grown::tiling_noise(u * 48, 0.5f, 48, 1, salt + 11);
        c = cep ? Rgb(0.44f, 0.37f, 0.15f) * (1 + 0.12f * fine) : Rgb(0.66f, 0.62f, 0.50f) * (1 + 0.3f * gill);
      } else {
        const float from_top = v / gills_v;  // 0 at the top
        c = cap * (1 + 0.16f * patch + 0.08f * fine);
        c = mix(c, cap * (cep ? 1.9f : 1.35f) + Rgb(0.03f, 0.015f, 0.004f), 0.7f * smooth(0.75f, 1.0f, from_top));
        if (!cep) {
          const SinCos a = sin_cos(2 * pi * u);
          const V2 p = V2(a.cos, a.sin) * sin_cos(from_top * 1.5708f).sin;
          float white = 0;
          for (const Flake& f : flakes)
            white = std::max(white, smooth(1.15f, 0.8f, (p - f.at).length() / f.radius + 0.25f * fine));
          c = mix(c, Rgb(0.70f, 0.66f, 0.54f), white);
        }
      }
      canvas.at(x, y).colour = c;
    }
  }
  return canvas;
}

}  // namespace

Model make_mushroom(const MadeOptions& options) {
  const bool cep = options.form == "mushroom";
  Draws draws(options.seed, 0);
  Model model;
  const Rgb cap =
      options.colour.value_or(cep ? mix(Rgb(0.155f, 0.070f, 0.030f), Rgb(0.235f, 0.125f, 0.060f), draws.share())
                                  : mix(Rgb(0.43f, 0.030f, 0.014f), Rgb(0.46f, 0.085f, 0.015f), draws.share()));
  const int texture = add_texture(model, paint(cep, cap, options.seed), "mushroom", false);
  Rings g;
  g.material = g.cap_material = add_material(model, options.form, Rgb(1, 1, 1), texture);
  const std::vector<Profile> profile = profile_of(cep, draws);

  // The stalk bends, the cap tilts with it, its rim is not quite round.
  const V3 lean(draws.around(0, 0.16f), draws.around(0, 0.16f), 0);
  const float phase = draws.share(), second = draws.share(), uneven = draws.between(0.01f, 0.04f);
  const auto middle = [&](float h) { return V3(lean.x * h * h, lean.y * h * h, h); };
  for (std::size_t r = 0; r < profile.size(); ++r) {
    const Profile& p = profile[r];
    const bool in_cap = p.v < stalk_v;
    std::vector<V3> ring;
    for (int k = 0; k < sides; ++k) {
      const float turn = static_cast<float>(k) / sides;
      const SinCos a = sin_cos(2 * pi * turn);
      const float wave =
          uneven * (sin_cos(2 * pi * (2 * turn + phase)).sin + sin_cos(2 * pi * (3 * turn + second)).sin);
      const V3 out(a.cos, a.sin, 0);
      V3 at = middle(in_cap ? 0.72f : p.height) + out * (p.radius * (1 + wave));
      if (in_cap) {
        const float tilt = -(lean.x * out.x + lean.y * out.y) * p.radius;
        at.z = p.height + tilt + 0.6f * wave * p.radius;
        at.x += lean.x * (p.height - 0.6f);
        at.y += lean.y * (p.height - 0.6f);
      }
      ring.push_back(at);
    }
    g.rings.push_back(std::move(ring));
    g.v.push_back(p.v);
  }
  g.foot = V3(0, 0, -0.01f);
  g.tip = middle(0.72f) + V3(lean.x * 0.4f, lean.y * 0.4f, 0.285f);
  g.v_foot = 1;
  g.v_tip = 0;
  add_rings(model, g);
  return model;
}

}  // namespace ghosttile::objects::made
