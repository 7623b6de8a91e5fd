// Leaves: a card of sixteen triangles that keeps close to the outline, folded along the midrib, curled and twisted; the rest is painted.
#include <algorithm>
#include <cmath>

#include "ghosttile/objects/made/leaf_outline.h"
#include "ghosttile/objects/made/parts.h"

namespace ghosttile::objects::made {

namespace {

constexpr int size = 256;           // of the texture: the whole leaf with its stalk is as high
constexpr float half_view = 0.46f;  // of the leaf's length, to the texture's left and right

struct Look {
  Rgb near_veins, between, edge;
  float spots;  // share that is spotted brown
};

Look look_of(const std::string& form, Season season, Draws& draws) {
  const float turn = draws.share(), more = draws.share();
  const Rgb brown(0.125f, 0.062f, 0.028f);
  if (season == Season::winter) {
    const Rgb dead = mix(Rgb(0.105f, 0.068f, 0.042f), Rgb(0.15f, 0.105f, 0.068f), turn);
    return {dead * 1.1f, dead, dead * 0.8f, 0.6f};
  }
  if (season == Season::summer) {
    const Rgb green = form == "birch-leaf" ? Rgb(0.085f, 0.165f, 0.04f)
                      : form == "oak-leaf" ? Rgb(0.06f, 0.115f, 0.03f)
                                           : Rgb(0.062f, 0.128f, 0.036f);
    const Rgb c = green * mix(0.85f, 1.2f, turn);
    return {c * 1.15f, c, c * 0.95f, 0.02f};
  }
  if (form == "maple-leaf") {
    // Yellow, orange or red; the veins stay yellow the longest.
    const Rgb yellow(0.47f, 0.30f, 0.035f), orange(0.46f, 0.145f, 0.022f), red(0.30f, 0.040f, 0.022f);
    const Rgb blade = turn < 0.5f ? mix(yellow, orange, 2 * turn) : mix(orange, red, 2 * turn - 1);
    return {mix(blade, yellow, 0.5f), blade, mix(blade, brown, 0.35f + 0.3f * more), 0.2f};
  }
  if (form == "birch-leaf") {
    const Rgb yellow = mix(Rgb(0.50f, 0.33f, 0.045f), Rgb(0.40f, 0.21f, 0.04f), turn);
    return {yellow * 0.9f, yellow, mix(yellow, brown, 0.5f * more), 0.35f};
  }
  if (form == "oak-leaf") {
    const Rgb c = mix(Rgb(0.235f, 0.125f, 0.042f), Rgb(0.155f, 0.078f, 0.034f), turn);
    return {c * 1.25f, c, mix(c, brown, 0.5f), 0.4f};
  }
  const Rgb copper = mix(Rgb(0.38f, 0.165f, 0.042f), Rgb(0.20f, 0.085f, 0.032f), turn);
  return {copper * 1.15f, copper, mix(copper, brown, 0.3f + 0.4f * more), 0.25f};
}

float distance(const V2& p, const V2& a, const V2& b, float& share) {
  const V2 along = b - a;
  share = clamp01((p - a).dot(along) / std::max(1e-9f, along.dot(along)));
  return (p - a - along * share).length();
}

class Painting {
 public:
  Painting(const LeafOutline& leaf, const Look& look, std::uint32_t salt) : leaf_(leaf), look_(look), salt_(salt) {}

  assets::grown::Canvas paint() const {
    assets::grown::Canvas canvas(size, size);
    for (int y = 0; y < size; ++y) {
      const std::vector<float> upper = crossings(static_cast<float>(y) + 0.25f),
                               lower = crossings(static_cast<float>(y) + 0.75f);
      for (int x = 0; x < size; ++x) {
        float covered = 0;
        for (const float dx : {0.25f, 0.75f}) {
          const float at = place(static_cast<float>(x) + dx, 0).x;
          covered += 0.25f * static_cast<float>(within(upper, at) + within(lower, at));
        }
        canvas.at(x, y) = texel(x, y, covered);
      }
    }
    return canvas;
  }

 private:
  // From texels to the outline's plane.
  V2 place(float x, float y) const {
    return {(2 * x / size - 1) * half_view / (1 - leaf_.stalk), (1 - y / size - leaf_.stalk) / (1 - leaf_.stalk)};
  }

  // Where a row of the texture crosses the outline.
  std::vector<float> crossings(float row) const {
    const float y = place(0, row).y;
    std::vector<float> result;
    for (std::size_t i = 0, j = leaf_.edge.size() - 1; i < leaf_.edge.size(); j = i++) {
      const V2 &a = leaf_.edge[i], &b = leaf_.edge[j];
      if ((a.y > y) != (b.y > y)) result.push_back(a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)));
    }
    return result;
  }
  static int within(const std::vector<float>& crossings, float x) {
    return static_cast<int>(std::count_if(crossings.begin(), crossings.end(), [x](float c) { return c > x; }) & 1);
  }

  assets::grown::Texel texel(int x, int y, float covered) const {
    const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
    assets::grown::Texel t;
    const V2 p = place(fx + 0.5f, fy + 0.5f);
    float share = 0;
    const float texel_width = 1 / (size * (1 - leaf_.stalk));
    const float stalk = distance(p, V2(0, -leaf_.stalk / (1 - leaf_.stalk) + 0.01f), V2(0, 0.1f), share);
    const float on_stalk = clamp01((0.013f - stalk) / texel_width + 0.5f);
    t.alpha = std::max(covered, on_stalk);
    if (t.alpha <= 0) return t;

    float to_edge = 1, to_vein = 1, vein = 0;
    for (std::size_t i = 0, j = leaf_.edge.size() - 1; i < leaf_.edge.size(); j = i++)
      to_edge = std::min(to_edge, distance(p, leaf_.edge[j], leaf_.edge[i], share));
    for (const Vein& v : leaf_.veins) {
      const float d = distance(p, v.from, v.to, share);
      to_vein = std::min(to_vein, d);
      vein = std::max(vein, clamp01(1.3f - d / (v.width * (1 - 0.5f * share))));
    }
    const float u = fx / size, v = fy / size;
    const float patch = rough(u, v, 4, 4, salt_), fine = rough(u, v, 24, 24, salt_ + 7);
    Rgb c = mix(look_.near_veins, look_.between, smooth(0.0f, 0.07f, to_vein + 0.02f * patch));
    c = mix(c, look_.edge, smooth(0.10f, 0.0f, to_edge + 0.05f * patch));
    c *= 1 + 0.16f * patch + 0.12f * fine;
    const float spot = rough(u, v, 9, 9, salt_ + 3);
    c = mix(c, Rgb(0.06f, 0.032f, 0.018f),
            0.75f * smooth(0.62f - 0.5f * look_.spots, 0.78f - 0.4f * look_.spots, spot));
    // The blade bulges between its veins: one side of each lies in shade.
    c *= 0.93f + 0.14f * smooth(0.0f, 0.05f, to_vein);
    c = mix(c, look_.near_veins * 1.25f + Rgb(0.015f, 0.012f, 0.004f), 0.6f * vein);
    t.colour = mix(c, mix(look_.near_veins, Rgb(0.16f, 0.09f, 0.04f), 0.5f), on_stalk * (covered > 0.5f ? 0.4f : 1.0f));
    return t;
  }

  const LeafOutline& leaf_;
  Look look_;
  std::uint32_t salt_;
};

}  // namespace

Model make_leaf(const MadeOptions& options) {
  Draws shape(options.seed, 0), paint(options.seed, 1), bend(options.seed, 2);
  const LeafOutline leaf = leaf_outline(options.form, shape);
  Look look = look_of(options.form, options.season, paint);
  if (options.colour) look = {*options.colour * 1.2f, *options.colour, *options.colour * 0.8f, 0.1f};
  Model model;
  const int texture = add_texture(
      model, Painting(leaf, look, static_cast<std::uint32_t>(options.seed * 131 + 17)).paint(), "leaf", true);
  const std::uint16_t material = add_material(model, options.form, Rgb(1, 1, 1), texture);
  model.materials[material].alpha_cutoff = 0.5f;
  // As assets/leaf.h: less passes than comes back, most in the green; a dry leaf lets through half of that.
  const float dry = options.season == Season::summer ? 1.0f : 0.6f;
  model.materials[material].transmittance = Rgb(0.6f, options.season == Season::summer ? 0.9f : 0.6f, 0.4f) * dry;

  // Rows of three corners across; each row as wide as the outline is near it. Stalks get a row of their own.
  std::vector<float> rows = leaf.stalk > 0.2f ? std::vector<float>{-leaf.stalk, -0.02f, 0.20f, 0.55f, 1}
                                              : std::vector<float>{-leaf.stalk, 0.06f, 0.32f, 0.66f, 1};
  const auto y_of_edge = [&](const V2& p) { return p.y * (1 - leaf.stalk); };
  for (std::size_t r = 1; r < rows.size(); ++r) rows[r] *= 1 - leaf.stalk;
  float top = 0;
  for (const V2& p : leaf.edge) top = std::max(top, y_of_edge(p));
  rows.back() = std::min(top, 1 - leaf.stalk);
  std::vector<float> half(rows.size(), 0.0f);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (const V2& p : leaf.edge) {
      const float y = y_of_edge(p), x = std::abs(p.x) * (1 - leaf.stalk);
      const bool below = r > 0 && y <= rows[r] && y >= rows[r - 1],
                 above = r + 1 < rows.size() && y >= rows[r] && y <= rows[r + 1];
      if (below || above) half[r] = std::max(half[r], std::min(half_view, 1.01f * x));
    }
  }
  half.front() = std::max(0.02f, leaf.stalk > 0.2f ? 0.02f : half.front());

  const bool fresh = options.season == Season::summer;
  const float curl = fresh ? bend.around(0.25f, 0.25f) : bend.sign() * bend.between(0.3f, 1.5f);
  const float fold = fresh ? bend.between(0.05f, 0.25f) : bend.between(0.05f, 0.6f) * bend.sign();
  const float twist = (fresh ? 0.2f : 0.8f) * bend.around(0, 1);
  const float whole = rows.back() - rows.front();
  const float middle = 0.5f * (rows.back() + rows.front());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    // Along an arc of `curl` radians over the whole length.
    const float t = (rows[r] - middle) / whole;
    const SinCos at = sin_cos(curl * t);
    const float radius = std::abs(curl) > 0.02f ? whole / curl : 0;
    const V3 spine = radius != 0 ? V3(radius * at.sin, 0, radius * (1 - at.cos)) : V3(whole * t, 0, 0);
    const V3 along(at.cos, 0, at.sin), up(-at.sin, 0, at.cos);
    const SinCos turn = sin_cos(twist * t);
    const V3 across = V3(0, 1, 0) * turn.cos + up * turn.sin, normal = along.cross(across);
    for (const float side : {1.0f, 0.0f, -1.0f}) {
      // The fold flattens toward the tip and the stalk.
      const float lift =
          std::abs(side) * fold * half[r] * (1 - 2 * t * t) + bend.around(0, fresh ? 0.004f : 0.02f) * std::abs(side);
      model.positions.push_back(spine + across * (side * half[r]) + normal * lift);
      model.uvs.push_back({0.5f - side * half[r] / (2 * half_view), 1 - (rows[r] + leaf.stalk)});
    }
  }
  for (std::uint32_t r = 0; r + 1 < rows.size(); ++r) {
    for (std::uint32_t c = 0; c < 2; ++c) {
      // Columns run from left (+y) to right, rows along x: anticlockwise from above.
      const std::uint32_t a = r * 3 + c, b = a + 3;
      model.triangles.push_back({a, a + 1, b + 1});
      model.triangles.push_back({a, b + 1, b});
      model.triangle_materials.insert(model.triangle_materials.end(), 2, material);
    }
  }
  smooth_normals(model);
  return model;
}

}  // namespace ghosttile::objects::made
