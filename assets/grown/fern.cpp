#include <algorithm>
#include <vector>

#include "assets/grown/canvas.h"
#include "assets/grown/low.h"
#include "assets/grown/paint.h"
#include "assets/grown/strip.h"

namespace assets::grown {

namespace {

constexpr int fronds = 17, most_pairs = 30, rachis_ribs = 14;

struct Frond {
  std::vector<V3> points;  // along the rachis
  V3 side;                 // to its left, level
  float length = 0;
};

// Rises steeply, then arches over; the outer fronds lie lower than the inner.
Frond shape_frond(float height, float radius, float azimuth, float inner, Draws& draws) {
  const SinCos a = sin_cos(azimuth);
  const V3 out(a.cos, a.sin, 0);
  const float reach = radius * mix(1.0f, 0.55f, inner) * draws.between(0.85f, 1.0f);
  const float top = height * mix(0.72f, 1.05f, inner) * draws.between(0.85f, 1.0f);
  const float tip = top * mix(0.45f, 0.8f, inner) * draws.between(0.8f, 1.1f);
  const V3 foot = out * (0.04f * radius), knee = out * (0.3f * reach) + V3(0, 0, 1.25f * top),
           end = out * reach + V3(0, 0, tip);
  const V3 sway = V3(-a.sin, a.cos, 0) * (draws.around(0, 0.18f) * reach);
  Frond frond;
  frond.side = V3(-a.sin, a.cos, 0);
  for (int i = 0; i <= rachis_ribs; ++i) {
    const float t = static_cast<float>(i) / rachis_ribs, s = 1 - t;
    frond.points.push_back(foot * (s * s) + knee * (2 * s * t) + end * (t * t) + sway * (t * t));
    if (i > 0)
      frond.length +=
          length_of(frond.points[static_cast<std::size_t>(i)] - frond.points[static_cast<std::size_t>(i) - 1]);
  }
  return frond;
}

// One pinna: pinnules left and right of a midrib, growing smaller to the tip. The midrib runs up the middle.
Texture paint_pinna(const Form& form, std::uint64_t seed) {
  constexpr int width = 64, height = 256;
  Canvas canvas(width, height);
  Draws draws(seed, 5);
  constexpr int pinnules = 16;
  for (int i = 0; i < pinnules; ++i) {
    const float t = (static_cast<float>(i) + 0.5f) / pinnules;
    const float foot = (1 - t) * (height - 8) + 4;
    const float reach = (0.5f * width - 2) * power(1 - t, 0.6f) * draws.between(0.9f, 1.0f);
    for (const float side : {-1.0f, 1.0f}) {
      const Rgb shade = form.leaf_colour * (1 + 0.5f * form.leaf_vary * draws.bell());
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          const float out = side * (static_cast<float>(x) + 0.5f - 0.5f * width);
          if (out < 0 || out > reach) continue;
          // Pinnules lean towards the tip and are blunt.
          const float across = static_cast<float>(y) + 0.5f - (foot - 0.35f * out);
          const float half = 0.47f * (height - 8.0f) / pinnules * std::sqrt(std::max(0.0f, 1 - power(out / reach, 4)));
          const float alpha = clamp01(half - std::abs(across) + 0.5f);
          if (alpha <= 0) continue;
          Texel& texel = canvas.at(x, y);
          texel.colour = shade * (0.9f + 0.2f * clamp01(std::abs(across) / half));
          texel.alpha = std::max(texel.alpha, alpha);
        }
      }
    }
  }
  for (int y = 6; y < height; ++y) {
    for (int x = width / 2 - 1; x <= width / 2; ++x) canvas.at(x, y) = {form.leaf_colour * 1.3f, 1};
  }
  return to_texture(std::move(canvas), "pinna", true);
}

V3 point_at(const Frond& frond, float share) {
  const float at = clamp01(share) * rachis_ribs;
  const int i = std::min(static_cast<int>(at), rachis_ribs - 1);
  return mix(frond.points[static_cast<std::size_t>(i)], frond.points[static_cast<std::size_t>(i) + 1],
             at - static_cast<float>(i));
}

void add_pinna(Model& model, const Frond& frond, float share, float side, int pairs, int columns, int rows,
               Draws& draws) {
  // Longest a third of the way up; the lowest fifth of the stalk is bare.
  const float t = (share - 0.2f) / 0.8f;
  const float outline = t < 0.25f ? mix(0.55f, 1.0f, t / 0.25f) : power((1 - t) / 0.75f, 0.8f);
  const float length = 0.24f * frond.length * std::max(0.06f, outline) * draws.between(0.9f, 1.05f);
  const V3 foot = point_at(frond, share);
  const V3 along_rachis = unit(point_at(frond, share + 0.02f) - point_at(frond, share - 0.02f));
  const V3 up = beside(frond.side.cross(along_rachis) * -1.0f, along_rachis);
  const V3 way = unit(frond.side * side + along_rachis * 0.42f + up * draws.around(0.02f, 0.1f));
  const V3 normal = beside(up.z < 0 ? -up : up, way);
  const float half = std::min(0.6f * 0.8f * frond.length / pairs, 0.16f * length);
  std::vector<Rib> ribs;
  for (int r = 0; r <= rows; ++r) {
    const float s = static_cast<float>(r) / static_cast<float>(rows);
    Rib rib;
    rib.middle = foot + way * (length * s) - normal * (0.12f * length * s * s);
    rib.normal = unit(normal + way * (0.24f * s));
    rib.across = unit(way.cross(normal));
    rib.half_width = half;
    rib.v = 1 - s;
    ribs.push_back(rib);
  }
  Ribbon ribbon;
  ribbon.columns = columns;
  ribbon.fold = columns > 1 ? 0.15f : 0;
  ribbon.material = static_cast<std::uint16_t>(1 + static_cast<int>(draws.share() * 3));
  add_ribbon(model, ribs, ribbon);
}

}  // namespace

void add_fern(Model& model, const Form& form, float height_m, float radius_m, std::uint64_t seed,
              std::size_t triangles) {
  Material rachis;
  rachis.name = "rachis";
  rachis.reflectance = Rgb(0.10f, 0.10f, 0.035f);
  model.materials.push_back(rachis);
  add_leaf_materials(model, form, paint_pinna(form, seed));
  // What the rachises leave is for the pinnae: as many in all details but the coarsest, with finer or coarser grids.
  const bool coarse = triangles < 3500;
  const int joint = coarse ? 7 : 1;  // every so many-th point of the rachis
  const float left =
      static_cast<float>(triangles) - static_cast<float>(fronds * rachis_ribs / joint * (coarse ? 2 : 4));
  const int pairs = std::clamp(static_cast<int>(left / (fronds * 4)), 2, most_pairs);
  const float each = left / static_cast<float>(fronds * pairs * 2);
  const int columns = each >= 24 ? 4 : each >= 8 ? 2 : 1;
  const float rows = std::max(1.0f, each / static_cast<float>(2 * columns));
  float carried = 0;  // rows are whole; what is left over goes to the next pinna
  Draws draws(seed, 4);
  for (int f = 0; f < fronds; ++f) {
    const float inner = static_cast<float>(f % 3) / 2 * draws.between(0.6f, 1.0f);
    const Frond frond =
        shape_frond(height_m, radius_m, 2.39996f * static_cast<float>(f) + draws.around(0, 0.25f), inner, draws);
    for (const bool upright : {false, true}) {
      if (upright && coarse) continue;
      std::vector<Rib> ribs;
      for (std::size_t i = 0; i < frond.points.size(); i += static_cast<std::size_t>(joint)) {
        const V3 along =
            unit(frond.points[std::min(i + 1, frond.points.size() - 1)] - frond.points[i == 0 ? 0 : i - 1]);
        const V3 up = beside(V3(0, 0, 1), along);
        const float thick = 0.006f * frond.length * (1.05f - static_cast<float>(i) / rachis_ribs);
        ribs.push_back({frond.points[i], upright ? up : along.cross(up), upright ? along.cross(up) : up, thick, 0});
        if (i == 0) ribs.back().middle -= V3(0, 0, 0.3f);
      }
      add_ribbon(model, ribs, {});
    }
    for (int i = 0; i < pairs; ++i) {
      const float share = mix(0.2f, 0.985f, (static_cast<float>(i) + 0.5f) / pairs);
      for (const float side : {-1.0f, 1.0f}) {
        carried += rows;
        const int whole = std::max(1, static_cast<int>(carried));
        carried -= static_cast<float>(whole);
        add_pinna(model, frond, share, side, pairs, columns, whole, draws);
      }
    }
  }
}

}  // namespace assets::grown
