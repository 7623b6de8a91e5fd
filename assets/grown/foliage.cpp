#include "assets/grown/foliage.h"

#include <algorithm>

#include "assets/grown/paint.h"

namespace assets::grown {

namespace {

constexpr int shades = 3;         // of add_leaf_materials()
constexpr float outward = 0.35f;  // how far the normals lean out of the crown

// Columns and rows of a card's grid of quads.
struct Grid {
  int columns = 1, rows = 1;
  std::size_t triangles() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) * 2; }
};

struct Card {
  V3 foot, along, normal;
  float length = 0;
  int tile = 0;
  bool mirrored = false;
};

void add_card(Model& model, const Card& card, const Grid& grid, const V3& crown_centre, std::uint16_t material) {
  const V3 across = card.along.cross(card.normal);
  const auto base = static_cast<std::uint32_t>(model.positions.size());
  const float u0 = 0.5f * static_cast<float>(card.tile % 2), v0 = 0.5f * static_cast<float>(card.tile / 2);
  const V3 out = unit(card.foot + card.along * (0.5f * card.length) - crown_centre);
  for (int r = 0; r <= grid.rows; ++r) {
    for (int c = 0; c <= grid.columns; ++c) {
      const float x = static_cast<float>(c) / static_cast<float>(grid.columns) - 0.5f;
      const float y = static_cast<float>(r) / static_cast<float>(grid.rows);
      // Folded along the middle, hanging towards the tip.
      const float fold = grid.columns > 1 ? 0.35f * std::abs(x) : 0, hang = grid.rows > 1 ? -0.22f * y * y : 0;
      model.positions.push_back(card.foot + (across * x + card.along * y + card.normal * (fold + hang)) * card.length);
      V3 normal = card.normal;
      if (grid.columns > 1) normal -= across * (x < 0 ? -0.35f : x > 0 ? 0.35f : 0);
      if (grid.rows > 1) normal += card.along * (0.44f * y);
      normal = unit(normal, card.normal);
      // On the side that looks outward anyway, the normal leans further out.
      normal = unit(normal + out * (normal.dot(out) < 0 ? -outward : outward), card.normal);
      model.normals.push_back(normal);
      const float u = card.mirrored ? 0.5f - x : 0.5f + x;
      model.uvs.push_back({u0 + 0.5f * u, v0 + 0.5f * (1 - y)});
    }
  }
  const auto width = static_cast<std::uint32_t>(grid.columns) + 1;
  for (std::uint32_t r = 0; r < static_cast<std::uint32_t>(grid.rows); ++r) {
    for (std::uint32_t c = 0; c + 1 < width; ++c) {
      const std::uint32_t a = base + r * width + c, b = a + 1, d = a + width, e = d + 1;
      model.triangles.push_back({a, b, e});
      model.triangles.push_back({a, e, d});
      model.triangle_materials.insert(model.triangle_materials.end(), 2, material);
    }
  }
}

// The leafed stretches of all axes, end to end.
struct Stretch {
  std::size_t axis;
  float until;  // running sum of lengths, this one included
};

std::vector<Stretch> leafed_stretches(const Skeleton& skeleton) {
  std::vector<Stretch> stretches;
  float sum = 0;
  for (std::size_t i = 0; i < skeleton.axes.size(); ++i) {
    const Axis& axis = skeleton.axes[i];
    if (axis.leafed_from >= 1) continue;
    sum += axis.length * (1 - axis.leafed_from);
    stretches.push_back({i, sum});
  }
  return stretches;
}

struct Place {
  const Axis* axis;
  float share;
  bool whole = false;  // the card stands for a whole branch
};

// A card that is larger than its twig shows the twig's whole branch, and lies along that; it does not end far beyond
// the tip. So crowns keep their outline and their tiers with few cards.
Place place_of(const Skeleton& skeleton, const Axis& twig, float share, float card_length) {
  Place place{&twig, share, false};
  while (place.axis->order > 1 && place.axis->length < 0.7f * card_length) {
    place.whole = true;
    place.share = place.axis->parent_share;
    place.axis = &skeleton.axes[static_cast<std::size_t>(place.axis->parent)];
  }
  const float length = std::max(place.axis->length, 1e-4f);
  const float beyond = place.share + 0.75f * card_length / length - 1.05f;
  if (beyond > 0) place.share = std::max(std::min(place.share, 0.05f), place.share - beyond);
  return place;
}

}  // namespace

void add_foliage(Model& model, const Skeleton& skeleton, const Form& form, float height_m, std::uint64_t seed,
                 const FoliageBudget& budget) {
  const std::vector<Stretch> stretches = leafed_stretches(skeleton);
  if (stretches.empty() || budget.triangles < 2) return;
  // As many cards as the triangles allow; but a card is not smaller than a leaf: then each has more triangles.
  const bool needles = form.leaf == Leaf::comb || form.leaf == Leaf::bottle || form.leaf == Leaf::rosette ||
                       form.leaf == Leaf::scales || form.leaf == Leaf::tuft;
  const float least_length = form.leaf_length_m * (needles ? 2.0f : 1.15f);
  const auto most_cards =
      std::max<std::size_t>(16, static_cast<std::size_t>(budget.leaf_area_m2 / (0.4f * least_length * least_length)));
  Grid grid;
  while (budget.triangles / grid.triangles() > most_cards && grid.rows < 64) {
    if (grid.columns == 1 && grid.rows == 2)
      grid.columns = 2;
    else if (grid.columns == 1)
      grid.rows = 2;
    else if (grid.columns == 2 && grid.rows >= 4)
      grid.columns = 4;
    else
      ++grid.rows;
  }
  const std::size_t count = std::max<std::size_t>(1, budget.triangles / grid.triangles());
  const float each_m2 = budget.leaf_area_m2 / static_cast<float>(count);
  const Sprays sprays = paint_sprays(form, std::sqrt(each_m2 / 0.5f), seed);
  const float length = std::sqrt(each_m2 / std::max(0.05f, sprays.filled));

  const std::uint16_t first_material = add_leaf_materials(model, form, sprays.texture);
  const float total = stretches.back().until;
  const V3 centre(0, 0, mix(form.crown_base, 1.0f, 0.35f) * height_m);
  std::size_t at = 0;
  Draws draws(seed, 2);
  const std::size_t points = static_cast<std::size_t>(grid.columns + 1) * static_cast<std::size_t>(grid.rows + 1);
  model.positions.reserve(model.positions.size() + count * points);
  model.normals.reserve(model.normals.size() + count * points);
  model.uvs.reserve(model.uvs.size() + count * points);
  model.triangles.reserve(model.triangles.size() + count * grid.triangles());
  model.triangle_materials.reserve(model.triangles.size() + count * grid.triangles());
  for (std::size_t i = 0; i < count; ++i) {
    // One card in each of `count` equal parts of the leafed length.
    const float way = (static_cast<float>(i) + draws.share()) / static_cast<float>(count) * total;
    while (at + 1 < stretches.size() && stretches[at].until < way) ++at;
    const Axis& twig = skeleton.axes[stretches[at].axis];
    const float left = (stretches[at].until - way) / std::max(1e-6f, twig.length * (1 - twig.leafed_from));
    Card card;
    card.length = length * draws.between(0.8f, 1.2f);
    const Place place = place_of(skeleton, twig, 1 - clamp01(left) * (1 - twig.leafed_from), card.length);
    const Spot spot = spot_at(skeleton, *place.axis, place.share);
    // The end of the twig bears a spray that goes straight on.
    const float angle = radians(form.spray_angle_deg) * (place.share > 0.97f ? 0.2f : 1.0f) + draws.around(0, 0.25f);
    const float tumble = form.tumble * (place.whole ? 0.5f : 1.0f);
    const V3 up = beside(V3(0, 0, 1) + draws.direction() * 0.1f, spot.direction);
    const V3 flat = spot.direction.cross(up) * (draws.share() < 0.5f ? 1.0f : -1.0f);
    const SinCos roll = sin_cos(draws.around(0, pi * tumble));
    const V3 side = unit(flat * roll.cos + up * roll.sin);
    const SinCos a = sin_cos(angle);
    V3 along = unit(spot.direction * a.cos + side * a.sin);
    along = unit(mix(along, V3(0, 0, form.spray_hang > 0 ? -1 : 1), std::abs(form.spray_hang)), along);
    card.along = along;
    card.normal = beside(mix(V3(0, 0, 1), draws.direction(), tumble), along);
    if (card.normal.z < 0) card.normal = -card.normal;
    // Sprays in the inner crown begin at the bark, not in the wood's middle; their foot overlaps the twig a little.
    card.foot = spot.position - along * (0.06f * card.length);
    card.tile = static_cast<int>(draws.share() * 4);
    card.mirrored = draws.share() < 0.5f;
    const auto shade = static_cast<std::uint16_t>(draws.share() * shades);
    add_card(model, card, grid, centre, static_cast<std::uint16_t>(first_material + shade));
  }
}

}  // namespace assets::grown
