#include "ghosttile/objects/made/leaf_outline.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace ghosttile::objects::made {

namespace {

using assets::grown::power;
using assets::grown::sine;

// A right half, foot to tip; the left one is its mirror, both a little off.
std::vector<V2> both_sides(std::span<const V2> half, float wander, Draws& draws) {
  std::vector<V2> edge;
  const auto off = [&](const V2& p) { return V2(p.x + draws.around(0, wander), p.y + draws.around(0, wander)); };
  for (const V2& p : half) edge.push_back(off(p));
  for (std::size_t k = half.size(); k-- > 0;) {
    if (half[k].x > 0) edge.push_back(off(V2(-half[k].x, half[k].y)));
  }
  return edge;
}

// Side veins that leave the midrib in pairs and run toward the edge, rising at `angle`.
void feather(LeafOutline& leaf, int pairs, float low, float high, float rise, const auto& half_width) {
  leaf.veins.push_back({V2(0, -1), V2(0, 0), 0.022f});
  for (int k = 0; k < 6; ++k) {
    const auto y = static_cast<float>(k) * 0.163f;
    leaf.veins.push_back({V2(0, y), V2(0, y + 0.163f), 0.022f * (1 - 0.5f * y)});
  }
  for (int i = 0; i < pairs; ++i) {
    const float y = mix(low, high, static_cast<float>(i) / static_cast<float>(pairs - 1));
    for (const float side : {-1.0f, 1.0f}) {
      // Where the vein meets the edge, by small steps.
      float x = 0;
      while (x < 0.6f && x < 0.95f * half_width(std::min(1.0f, y + rise * x))) x += 0.01f;
      leaf.veins.push_back({V2(0, y), V2(side * x, y + rise * x), 0.010f});
    }
  }
}

template <typename HalfWidth>
std::vector<V2> sampled(HalfWidth&& half_width, int count) {
  std::vector<V2> half;
  for (int i = 0; i <= count; ++i) {
    const float y = static_cast<float>(i) / static_cast<float>(count);
    half.push_back({std::max(0.0f, half_width(y)), y});
  }
  return half;
}

LeafOutline drawn(const std::string& form, Draws& draws) {
  LeafOutline leaf;
  if (form == "maple-leaf") {
    leaf.stalk = 0.34f;
    static constexpr float half[][2] = {
        {0.00f, 0.10f},   {0.05f, 0.05f},  {0.13f, 0.00f},  {0.24f, 0.00f},  {0.36f, 0.06f},  {0.30f, 0.13f},
        {0.33f, 0.20f},   {0.24f, 0.255f}, {0.36f, 0.29f},  {0.45f, 0.38f},  {0.62f, 0.47f},  {0.52f, 0.535f},
        {0.53f, 0.65f},   {0.40f, 0.61f},  {0.34f, 0.655f}, {0.20f, 0.55f},  {0.155f, 0.60f}, {0.24f, 0.72f},
        {0.335f, 0.775f}, {0.215f, 0.82f}, {0.175f, 0.90f}, {0.09f, 0.885f}, {0.0f, 1.06f}};
    std::vector<V2> points;
    for (const auto& p : half) points.push_back({p[0], p[1]});
    leaf.edge = both_sides(points, 0.012f, draws);
    const V2 heart(0, 0.10f);
    leaf.veins.push_back({V2(0, -1), heart, 0.028f});
    for (const V2& tip : {V2(0, 1.0f), V2(0.56f, 0.48f), V2(-0.56f, 0.48f), V2(0.31f, 0.06f), V2(-0.31f, 0.06f)}) {
      leaf.veins.push_back({heart, tip, 0.018f});
      for (const float share : {0.45f, 0.65f}) {
        const V2 along = tip - heart, across(-along.y, along.x);
        const V2 from = heart + along * share;
        for (const float side : {-0.22f, 0.22f})
          leaf.veins.push_back({from, from + along * 0.18f + across * side, 0.008f});
      }
    }
    return leaf;
  }
  if (form == "oak-leaf") {
    leaf.stalk = 0.07f;
    // Round lobes, wider toward the tip.
    const auto half = [](float y) {
      const float whole = 0.33f * power(sine(pi * power(y, 1.35f)), 0.62f);
      const float lobe = 0.5f + 0.5f * sine(2 * pi * (4.3f * y + 0.62f));
      return whole * (0.55f + 0.45f * power(lobe, 0.5f));
    };
    leaf.edge = both_sides(sampled(half, 48), 0.006f, draws);
    feather(leaf, 5, 0.12f, 0.74f, 0.75f, half);
    return leaf;
  }
  if (form == "birch-leaf") {
    leaf.stalk = 0.26f;
    const auto half = [](float y) {
      const float whole = y < 0.24f ? 0.40f * power(y / 0.24f, 0.55f) : 0.40f * power((1 - y) / 0.76f, 1.15f);
      const float tooth = y > 0.2f && y < 0.97f ? 13 * y - std::floor(13 * y) : 0.5f;
      return whole * (1 + 0.10f * (0.5f - tooth)) +
             0.018f * (0.5f - tooth) * smooth(0.1f, 0.3f, y) * smooth(1.0f, 0.9f, y);
    };
    leaf.edge = both_sides(sampled(half, 78), 0.002f, draws);
    feather(leaf, 5, 0.10f, 0.68f, 0.85f, half);
    return leaf;
  }
  leaf.stalk = 0.11f;
  const float phase = draws.share();
  const auto half = [phase](float y) {
    const float whole = 0.325f * power(sine(pi * power(y, 0.86f)), 0.78f);
    return whole * (1 + 0.02f * sine(2 * pi * (8 * y + phase)));
  };
  leaf.edge = both_sides(sampled(half, 48), 0.002f, draws);
  feather(leaf, 8, 0.08f, 0.80f, 0.8f, half);
  return leaf;
}

}  // namespace

LeafOutline leaf_outline(const std::string& form, Draws& draws) {
  LeafOutline leaf = drawn(form, draws);
  // No two leaves are as wide, and their midribs bend.
  const float width = draws.between(0.86f, 1.08f), bow = draws.around(0, 0.10f), skew = draws.around(0, 0.06f);
  const auto bent = [&](const V2& p) {
    const float y = clamp01(p.y);
    return V2(p.x * width + bow * y * (1 - y), p.y + skew * p.x);
  };
  for (V2& p : leaf.edge) p = bent(p);
  for (Vein& v : leaf.veins) {
    v.from = bent(v.from);
    v.to = bent(v.to);
  }
  return leaf;
}

}  // namespace ghosttile::objects::made
