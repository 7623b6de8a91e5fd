#include <algorithm>

#include "assets/grown/canvas.h"
#include "assets/grown/paint.h"

namespace assets::grown {

namespace {

constexpr int tile_px = 128;    // one spray
constexpr float margin_px = 2;  // stays empty, so that neighbours in the atlas do not bleed
constexpr float least_leaf_px = 9, least_needle_px = 9, needle_width_px = 1.7f;

V2 turned(const V2& d, float angle) {
  const SinCos a = sin_cos(angle);
  return {d.x * a.cos - d.y * a.sin, d.x * a.sin + d.y * a.cos};
}

// Half of a leaf's width at x in [0,1] from its foot to its tip, as a share of its greatest half width; not above `widest`.
constexpr float widest = 1.11f;
float half_width(Leaf leaf, float x) {
  if (x <= 0 || x >= 1) return 0;
  switch (leaf) {
    case Leaf::lanceolate:
      return power(sine(pi * power(x, 0.85f)), 0.9f);
    case Leaf::heart:
      return x < 0.12f ? 0.55f + 2.5f * x : power((1 - x) / 0.88f, 0.75f) * (1 + 0.1f * sine(pi * x));
    case Leaf::small:
      return x < 0.25f ? power(x / 0.25f, 0.6f) : power((1 - x) / 0.75f, 0.9f);
    case Leaf::lobed:
      return power(sine(pi * power(x, 1.3f)), 0.7f) * (0.76f + 0.24f * cosine(2 * pi * 4.4f * x));
    default:
      return power(sine(pi * power(x, 0.8f)), 0.8f);
  }
}

class Painter {
 public:
  Painter(const Form& form, float spray_length_m, std::uint64_t seed)
      : form_(form), canvas_(2 * tile_px, 2 * tile_px), draws_(seed, 3), ratio_(form.leaf_length_m / spray_length_m) {}

  Sprays paint() {
    for (int tile = 0; tile < 4; ++tile) {
      left_ = (tile % 2) * tile_px;
      top_ = (tile / 2) * tile_px;
      const V2 foot(0.5f * tile_px, tile_px - margin_px);
      paint_spray(foot);
    }
    Sprays sprays;
    for (const Texel& t : canvas_.texels) sprays.filled += t.alpha >= 0.5f ? 1 : 0;
    sprays.filled /= static_cast<float>(canvas_.texels.size());
    sprays.texture = to_texture(std::move(canvas_), "spray", true);
    return sprays;
  }

 private:
  void paint_spray(const V2& foot) {
    const V2 up(0, -1);
    switch (form_.leaf) {
      case Leaf::comb:
      case Leaf::bottle:
      case Leaf::rosette:
        needle_spray(foot, up);
        break;
      case Leaf::tuft:
        tuft_spray(foot, up);
        break;
      case Leaf::scales:
        fan(foot, up, 0.42f * tile_px, 4.5f, 0);
        break;
      default:
        leaf_spray(foot, up);
        break;
    }
  }

  Rgb leaf_shade() {
    const float b = 1 + form_.leaf_vary * draws_.bell() * 0.7f;
    const float yellow = 0.5f * form_.leaf_vary * draws_.bell();
    const Rgb c = form_.leaf_colour * std::max(0.35f, b);
    return Rgb(c.x * std::max(0.5f, 1 + yellow), c.y, c.z * std::max(0.5f, 1 - yellow));
  }

  // A broad leaf's size on the canvas.
  float leaf_px() const { return std::clamp(ratio_ * tile_px, least_leaf_px, 0.62f * tile_px); }

  void leaf_spray(const V2& foot, const V2& up) {
    const float leaf = leaf_px();
    const float length = tile_px - 2 * margin_px - 0.75f * leaf;
    // Sprays of many leaves have side shoots.
    if (leaf < 0.3f * tile_px) {
      const float gap = std::max(1.25f * leaf, 0.11f * length);
      int side = draws_.share() < 0.5f ? 1 : -1;
      for (float s = 0.12f * length; s < 0.85f * length; s += gap * draws_.between(0.7f, 1.2f)) {
        side = -side;
        const V2 at = foot + up * s;
        const V2 way = turned(up, static_cast<float>(side) * draws_.between(0.7f, 1.1f));
        leafy_shoot(at, way,
                    std::min(0.55f * length, (0.42f * tile_px - 0.3f * leaf) / 0.9f) * draws_.between(0.7f, 1.0f) *
                        (1 - 0.35f * s / length),
                    leaf);
      }
    }
    leafy_shoot(foot, up, length, leaf);
  }

  void leafy_shoot(V2 at, V2 way, float length, float leaf) {
    const float gap = (form_.leaf == Leaf::pinnate ? 0.42f : 0.36f) * leaf;
    const int count = std::max(2, static_cast<int>(length / gap));
    int side = draws_.share() < 0.5f ? 1 : -1;
    const float bend = draws_.around(0, 0.25f) / static_cast<float>(count);
    for (int i = 0; i <= count; ++i) {
      const bool last = i == count;
      if (i > 0 || count < 4) {
        side = -side;
        const V2 d =
            turned(way, last ? draws_.around(0, 0.3f) : static_cast<float>(side) * draws_.between(0.6f, 1.15f));
        one_leaf(at, d, leaf * draws_.between(0.75f, 1.05f));
      }
      if (last) break;
      const V2 next = at + way * (length / static_cast<float>(count));
      stroke(at, next, std::max(1.0f, 0.05f * leaf), 0.8f, form_.twig_colour);
      at = next;
      way = turned(way, bend);
    }
  }

  void one_leaf(const V2& foot, const V2& way, float length) {
    if (form_.leaf == Leaf::palmate) {
      palm_leaf(foot, way, length);
    } else if (form_.leaf == Leaf::pinnate) {
      const int pairs = length > 30 ? 5 : 3;
      const Rgb shade = leaf_shade();
      stroke(foot, foot + way * (0.8f * length), 1.4f, 0.8f, shade);
      for (int i = 0; i < pairs; ++i) {
        const V2 at = foot + way * (length * mix(0.2f, 0.75f, static_cast<float>(i) / static_cast<float>(pairs - 1)));
        for (const float side : {-1.0f, 1.0f})
          blade(at, turned(way, side * 1.05f), 0.34f * length, 0.38f, Leaf::ovate, shade);
      }
      blade(foot + way * (0.75f * length), way, 0.3f * length, 0.4f, Leaf::ovate, shade);
    } else {
      blade(foot, way, length, form_.leaf_width_share, form_.leaf, leaf_shade());
    }
  }

  // Five lobes around the leaf's heart.
  void palm_leaf(const V2& foot, const V2& way, float length) {
    const V2 heart = foot + way * (0.38f * length);
    const Rgb shade = leaf_shade();
    stroke(foot, heart, 1.2f, 1.0f, shade);
    for (const float lobe : {-2.1f, 2.1f, -1.05f, 1.05f, 0.0f}) {
      const float size = std::abs(lobe) > 2 ? 0.36f : std::abs(lobe) > 1 ? 0.52f : 0.62f;
      blade(heart - way * (0.04f * length), turned(way, lobe), size * length, 0.55f, Leaf::ovate, shade);
    }
  }

  void needle_spray(const V2& foot, const V2& up) {
    const float needle = std::clamp(ratio_ * tile_px, least_needle_px, 0.3f * tile_px);
    const float length = tile_px - 2 * margin_px - 0.4f * needle;
    const float gap = std::max(1.15f * needle, 0.1f * tile_px);
    int side = 1;
    if (needle < 0.24f * tile_px) {
      for (float s = 0.1f * length; s < 0.85f * length; s += 0.5f * gap) {
        side = -side;
        const float angle = form_.leaf == Leaf::rosette ? draws_.between(0.8f, 1.3f) : draws_.between(0.75f, 0.95f);
        const float reach = std::min(0.5f * length * (1.05f - 0.75f * s / length), 0.42f * tile_px / 0.85f);
        needle_shoot(foot + up * s, turned(up, static_cast<float>(side) * angle), reach * draws_.between(0.8f, 1.0f),
                     needle);
      }
    }
    needle_shoot(foot, up, length, needle);
  }

  void needle_shoot(V2 at, V2 way, float length, float needle) {
    const float width = std::max(needle_width_px, 0.07f * needle);
    const V2 end = at + way * length;
    stroke(at, end, std::max(1.2f, 0.09f * needle), 0.8f, mix(form_.twig_colour, form_.leaf_colour, 0.4f));
    if (form_.leaf == Leaf::rosette) {
      const int count = std::max(2, static_cast<int>(length / (0.8f * needle)));
      for (int i = 1; i <= count; ++i) {
        const V2 heart = at + (end - at) * (static_cast<float>(i) / static_cast<float>(count));
        const Rgb shade = leaf_shade();
        for (int k = 0; k < 9; ++k) {
          const V2 d = turned(way, 2 * pi * (static_cast<float>(k) + draws_.share()) / 9);
          stroke(heart, heart + d * (needle * draws_.between(0.6f, 0.9f)), width, 0.8f, shade);
        }
      }
      return;
    }
    const float step = width * 1.25f;
    const bool bottle = form_.leaf == Leaf::bottle;
    for (float s = 0.02f * length; s <= length; s += step) {
      const V2 foot = at + way * s;
      const float shorter = s > 0.9f * length ? 0.75f : 1;
      const Rgb shade = leaf_shade();
      for (const float side : {-1.0f, 1.0f}) {
        const float angle = bottle ? draws_.between(0.35f, 0.85f) : draws_.between(0.95f, 1.2f);
        stroke(foot, foot + turned(way, side * angle) * (needle * shorter * draws_.between(0.75f, 1.0f)), width, 0.7f,
               shade);
      }
      if (bottle) stroke(foot, foot + turned(way, draws_.around(0, 0.3f)) * (0.8f * needle), width, 0.7f, shade);
    }
    for (int k = 0; k < 5; ++k)
      stroke(end, end + turned(way, draws_.around(0, 0.7f)) * (0.6f * needle), width, 0.7f, leaf_shade());
  }

  // Pines: needles stand at the outer end of each shoot only.
  void tuft_spray(const V2& foot, const V2& up) {
    const float needle = std::clamp(ratio_ * tile_px, 0.16f * tile_px, 0.5f * tile_px);
    const float length = tile_px - 2 * margin_px - 0.9f * needle;
    if (needle < 0.36f * tile_px) {
      int side = 1;
      const float gap = std::max(0.55f * needle, 0.12f * tile_px);
      for (float s = 0.1f * length; s < 0.95f * length; s += gap) {
        side = -side;
        const float reach = std::min(0.55f * length * (1.1f - 0.6f * s / length), 0.45f * tile_px - 0.8f * needle);
        tuft_shoot(foot + up * s, turned(up, static_cast<float>(side) * draws_.between(0.6f, 0.95f)),
                   std::max(3.0f, reach), needle);
      }
    }
    tuft_shoot(foot, up, length, needle);
  }

  void tuft_shoot(const V2& at, const V2& way, float length, float needle) {
    const V2 end = at + way * length;
    stroke(at, end, 2.2f, 1.6f, mix(form_.twig_colour, form_.bark_upper_colour, 0.5f));
    const float width = std::max(needle_width_px, 0.028f * needle);
    const int count = 46;
    for (int k = 0; k < count; ++k) {
      const V2 foot = mix_points(end, at, 0.65f * draws_.share() * std::min(1.0f, 1.3f * needle / length));
      const V2 d = turned(way, draws_.bell() * 0.5f);
      stroke(foot, foot + d * (needle * draws_.between(0.7f, 1.0f)), width, 0.6f, leaf_shade());
    }
  }

  static V2 mix_points(const V2& a, const V2& b, float t) { return a + (b - a) * t; }

  // Cedars: a flat fan of scaly twigs, each fork shorter.
  void fan(const V2& at, const V2& way, float length, float width, int depth) {
    V2 p = at, d = way;
    const int joints = 6;
    const float bend = draws_.around(0, 0.05f);
    const float whole = depth == 0 ? length * 2.1f : length;
    for (int i = 0; i < joints; ++i) {
      const V2 next = p + d * (whole / joints);
      stroke(p, next, width * (depth == 0 && i < 3 ? 0.6f : 0.8f), width * 0.7f, leaf_shade());
      p = next;
      d = turned(d, bend);
      if (depth < 2) {
        const float t = static_cast<float>(i + 1) / joints;
        const float reach = (depth == 0 ? 0.95f : 0.5f) * length * (1.05f - 0.7f * t);
        for (const float side : {-1.0f, 1.0f})
          fan(p, turned(d, side * draws_.between(0.5f, 0.75f)), reach * draws_.between(0.75f, 1.0f), width * 0.85f,
              depth + 1);
      }
    }
    stroke(p, p + d * (0.06f * length), width * 0.8f, 1, leaf_shade());
  }

  // A leaf: lighter along its midrib, one half a little darker than the other.
  void blade(const V2& foot, const V2& way, float length, float width_share, Leaf shape, const Rgb& shade) {
    const V2 across(-way.y, way.x);
    const float half = 0.5f * width_share * length;
    const V2 tip = foot + way * length;
    const float reach = half + 1;
    const Rgb rib = shade * 1.25f + Rgb(0.01f, 0.01f, 0.004f);
    each_texel({std::min(foot.x, tip.x) - reach, std::min(foot.y, tip.y) - reach},
               {std::max(foot.x, tip.x) + reach, std::max(foot.y, tip.y) + reach}, [&](const V2& p) {
                 const V2 q = p - foot;
                 const float x = q.dot(way) / length, y = q.dot(across);
                 Texel t;
                 if (x < 0 || x > 1 || std::abs(y) > widest * half + 0.5f) return t;
                 const float h = half * half_width(shape, x);
                 t.alpha = clamp01(h - std::abs(y) + 0.5f);
                 const float on_rib = length > 16 ? clamp01(1.2f - std::abs(y) / (0.03f * length)) : 0;
                 const float light = (y > 0 ? 1.06f : 0.94f) * (0.92f + 0.12f * x);
                 t.colour = mix(shade * light, rib, 0.6f * on_rib);
                 return t;
               });
  }

  // A tapered line with round ends.
  void stroke(const V2& a, const V2& b, float width_a, float width_b, const Rgb& colour) {
    const V2 along = b - a;
    const float square = std::max(1e-6f, along.dot(along));
    const float reach = 0.5f * std::max(width_a, width_b) + 1;
    each_texel({std::min(a.x, b.x) - reach, std::min(a.y, b.y) - reach},
               {std::max(a.x, b.x) + reach, std::max(a.y, b.y) + reach}, [&](const V2& p) {
                 const float t = clamp01((p - a).dot(along) / square);
                 const V2 off = p - (a + along * t);
                 Texel texel;
                 texel.colour = colour * (0.9f + 0.2f * t);
                 texel.alpha = clamp01(0.5f * mix(width_a, width_b, t) - std::sqrt(off.dot(off)) + 0.5f);
                 return texel;
               });
  }

  // Lays what `paint` says of each texel in a box over what is there.
  template <typename Paint>
  void each_texel(const V2& low, const V2& high, Paint&& paint) {
    const auto first = static_cast<int>(margin_px), last = tile_px - 1 - first;
    const int x0 = std::max(first, static_cast<int>(low.x)), x1 = std::min(last, static_cast<int>(high.x));
    const int y0 = std::max(first, static_cast<int>(low.y)), y1 = std::min(last, static_cast<int>(high.y));
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const Texel t = paint(V2(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f));
        if (t.alpha <= 0) continue;
        Texel& below = canvas_.at(left_ + x, top_ + y);
        below.colour = below.alpha > 0 ? mix(below.colour, t.colour, t.alpha) : t.colour;
        below.alpha = below.alpha + (1 - below.alpha) * t.alpha;
      }
    }
  }

  const Form& form_;
  Canvas canvas_;
  Draws draws_;
  float ratio_;
  int left_ = 0, top_ = 0;
};

}  // namespace

Sprays paint_sprays(const Form& form, float spray_length_m, std::uint64_t seed) {
  return Painter(form, spray_length_m, seed).paint();
}

std::uint16_t add_leaf_materials(Model& model, const Form& form, Texture texture) {
  const auto first = static_cast<std::uint16_t>(model.materials.size());
  for (int s = 0; s < 3; ++s) {
    const float step = static_cast<float>(s) - 1;
    const float bright = 1 + 0.6f * step * form.leaf_vary, yellow = 0.25f * step * form.leaf_vary;
    Material material;
    material.name = "leaf" + std::to_string(s + 1);
    material.reflectance = Rgb(bright * (1 + yellow), bright, bright * (1 - yellow));
    material.transmittance =
        Rgb(material.reflectance.x * form.leaf_passes.x, material.reflectance.y * form.leaf_passes.y,
            material.reflectance.z * form.leaf_passes.z);
    material.texture = static_cast<int>(model.textures.size());
    material.alpha_cutoff = 0.5f;
    model.materials.push_back(material);
  }
  model.textures.push_back(std::move(texture));
  return first;
}

}  // namespace assets::grown
