// Light at the ground: Beer-Lambert's law through crowns, from 29 directions of the sky.
//
// depth = extinction * leaf area density * path. A crown is an upright ellipsoid; its leaf area density is that of `leaf_area` leaves
// over its shadow from the zenith: leaf_area * pi R^2 / (4/3 pi R^2 a) = 3 leaf_area / (4 a), a its half height.
#include <algorithm>
#include <cmath>
#include <vector>

#include "assets/grown/draws.h"
#include "ghosttile/cover/fillers.h"
#include "silvasim/base/math.h"

namespace ghosttile::cover {

namespace {

constexpr std::size_t nodes = static_cast<std::size_t>(block_nodes) * block_nodes;

struct Direction {
  float x, y, z, weight;
};

// Rings of the sky, each for a band around it. Weights are the integrals of the standard overcast sky's light on level ground (Moon and
// Spencer 1942), (1 + 2 cos t) cos t sin t dt, over 0 to 12, 32, 52 and 80 degrees: c^2/2 + 2/3 c^3 between the bands' cosines.
struct Ring {
  float zenith_deg;
  int directions;
  float weight;
};
constexpr Ring rings[] = {{0, 1, 0.05607f}, {22, 6, 0.29274f}, {42, 10, 0.36679f}, {63, 12, 0.28440f}};
constexpr float lowest_slope = 1.97f;  // metres aside a metre up in the last ring, and a little more

std::vector<Direction> directions() {
  std::vector<Direction> all;
  float turn = 0;
  for (const Ring& ring : rings) {
    const auto [aside, up] = assets::grown::sin_cos(assets::grown::radians(ring.zenith_deg));
    for (int k = 0; k < ring.directions; ++k) {
      const float share = (static_cast<float>(k) + turn) / static_cast<float>(ring.directions);
      const auto [sine, cosine] = assets::grown::sin_cos(2 * assets::grown::pi * share);
      all.push_back({aside * cosine, aside * sine, up, ring.weight / static_cast<float>(ring.directions)});
    }
    turn += 0.37f;  // so that rings do not line up
  }
  return all;
}
const std::vector<Direction>& sky() {
  static const std::vector<Direction> all = directions();
  return all;
}

// Share of a plant's height that its crown takes. Rounded: spruce and fir in stands keep more than beech and oak; shrubs are all crown.
float crown_share(const Habit& habit, float height_m) {
  if (height_m < 5) return 0.9f;
  return habit.needles ? 0.7f : 0.6f;
}

// Of a species' plants, with the crown's radius as the unit.
struct Shape {
  float height = 1;   // of the plant
  float density = 0;  // extinction * leaf area density * half height
};

class LightFiller final : public Filler {
 public:
  LightFiller(Chosen chosen, const Light& light) : chosen_(std::move(chosen)) {
    const auto& species = chosen_.plants->species();
    reach_.assign(chosen_.plants->layer_count(), 0.0f);
    for (std::size_t s = 0; s < species.size(); ++s) {
      shapes_.push_back({species[s].height_per_radius,
                         light.extinction * 0.75f * light.leaf_area * foliage(species[s].habit, light.month)});
      if (!chosen_.selection.species[s]) continue;
      // A crown's shadow reaches no farther than its top's, plus its radius.
      const float reach = species[s].height_per_radius * lowest_slope + 1.5f;
      float& most = reach_[species[s].layer];
      most = std::max(most, reach * chosen_.selection.layers[species[s].layer].most_radius_m);
    }
  }

  void fill(const NodeBlock& block, float* values) const override {
    std::vector<Stem> stems;
    for (std::size_t l = 0; l < reach_.size(); ++l) {
      chosen_.plants->for_each(l, grown(block.box(), static_cast<double>(reach_[l])), chosen_.selection,
                               [&](const Stem& stem) {
                                 stems.push_back(stem);
                                 return true;
                               });
    }
    std::fill_n(values, nodes, 0.0f);
    std::vector<float> depth(nodes);
    for (const Direction& direction : sky()) {
      std::fill(depth.begin(), depth.end(), 0.0f);
      for (const Stem& stem : stems) add(stem, direction, block, depth.data());
      for (std::size_t i = 0; i < nodes; ++i) values[i] += direction.weight * silvasim::base::exp(-depth[i]);
    }
    for (std::size_t i = 0; i < nodes; ++i) values[i] = std::min(values[i], 1.0f);
  }

  Range range(const Box& box) const override {
    bool any = false;
    for (std::size_t l = 0; l < reach_.size() && !any; ++l) {
      any = chosen_.plants->any(l, grown(box, static_cast<double>(reach_[l])), chosen_.selection);
    }
    return {any ? 0.0f : open(), open()};
  }

 private:
  // As fill() adds it up where nothing stands.
  static float open() {
    float sum = 0;
    for (const Direction& direction : sky()) sum += direction.weight * silvasim::base::exp(-0.0f);
    return std::min(sum, 1.0f);
  }

  // Adds a crown's depth to the nodes in its shadow.
  void add(const Stem& stem, const Direction& to, const NodeBlock& block, float* depth) const {
    const Shape& shape = shapes_[stem.species];
    const float height = shape.height * stem.radius_m;
    const float radius = stem.radius_m;
    const float half = 0.5f * height * crown_share(chosen_.plants->species()[stem.species].habit, height);
    const float centre = height - half;
    const float away = centre / to.z;
    const auto wide = [&](float slope) { return std::sqrt(radius * radius + half * half * slope * slope); };
    const double wide_x = static_cast<double>(wide(to.x / to.z)), wide_y = static_cast<double>(wide(to.y / to.z));
    const double x = stem.x_m - static_cast<double>(away * to.x), y = stem.y_m - static_cast<double>(away * to.y);
    const NodeBlock::Span columns = block.columns(x - wide_x, x + wide_x), rows = block.rows(y - wide_y, y + wide_y);
    // The chord of the ray o + t d through a sphere of the crown's radius, z squeezed so that the crown becomes one.
    const float squeeze = radius / half, dz = to.z * squeeze, oz = -centre * squeeze;
    const float a = to.x * to.x + to.y * to.y + dz * dz, thick = shape.density / half / a;
    for (int j = rows.first; j <= rows.last; ++j) {
      const auto oy = static_cast<float>(block.y(j) - stem.y_m);
      float* const row = depth + j * block_nodes;
      for (int i = columns.first; i <= columns.last; ++i) {
        const auto ox = static_cast<float>(block.x(i) - stem.x_m);
        const float b = ox * to.x + oy * to.y + oz * dz, c = ox * ox + oy * oy + oz * oz - radius * radius;
        const float root = std::sqrt(std::max(0.0f, b * b - a * c));
        // Only what lies above the ground: a shrub's crown may reach down to it.
        const float from = std::max(0.0f, -b - root), until = std::max(0.0f, -b + root);
        row[i] += thick * (until - from);
      }
    }
  }

  Chosen chosen_;
  std::vector<Shape> shapes_;
  std::vector<float> reach_;  // by layer
};

}  // namespace

std::unique_ptr<const Filler> light(Chosen chosen, const Light& settings) {
  return std::make_unique<LightFiller>(std::move(chosen), settings);
}

}  // namespace ghosttile::cover
