// Crown cover, distance to stems and density of stands.
#include <algorithm>
#include <array>
#include <cmath>

#include "ghosttile/cover/fillers.h"

namespace ghosttile::cover {

namespace {

constexpr std::size_t nodes = static_cast<std::size_t>(block_nodes) * block_nodes;
constexpr double pi = 3.14159265358979323846;
constexpr double hectare_m2 = 10000;

// Calls visit(node's value, squared distance, stem) for all nodes within the stem's reach, and maybe a few more.
template <typename Reach, typename Visit>
void splat(const Chosen& chosen, const NodeBlock& block, float* values, Reach&& reach_of, Visit&& visit) {
  std::array<float, block_nodes> across;
  const Plants& plants = *chosen.plants;
  for (std::size_t l = 0; l < plants.layer_count(); ++l) {
    const double most = static_cast<double>(reach_of(chosen.selection.layers[l].most_radius_m));
    // A hair more: whether a stem at the very end of its reach counts must not depend on the block.
    const Box around = grown(block.box(), most + 0.01);
    plants.for_each(l, around, chosen.selection, [&](const Stem& stem) {
      const double reach = static_cast<double>(reach_of(stem.radius_m));
      const NodeBlock::Span columns = block.columns(stem.x_m - reach, stem.x_m + reach);
      const NodeBlock::Span rows = block.rows(stem.y_m - reach, stem.y_m + reach);
      for (int i = columns.first; i <= columns.last; ++i) {
        const auto dx = static_cast<float>(block.x(i) - stem.x_m);
        across[static_cast<std::size_t>(i)] = dx * dx;
      }
      for (int j = rows.first; j <= rows.last; ++j) {
        const auto dy = static_cast<float>(block.y(j) - stem.y_m);
        float* const row = values + j * block_nodes;
        for (int i = columns.first; i <= columns.last; ++i)
          visit(row[i], across[static_cast<std::size_t>(i)] + dy * dy, stem);
      }
      return true;
    });
  }
}

// Whether a plant stands within its layer's reach of the box.
template <typename Reach>
bool any_within(const Chosen& chosen, const Box& box, Reach&& reach_of) {
  for (std::size_t l = 0; l < chosen.plants->layer_count(); ++l) {
    const float most = chosen.selection.layers[l].most_radius_m;
    if (!(most > 0)) continue;
    if (chosen.plants->any(l, grown(box, static_cast<double>(reach_of(most))), chosen.selection)) return true;
  }
  return false;
}

class CrownFiller final : public Filler {
 public:
  CrownFiller(Chosen chosen, CrownCover cover) : chosen_(std::move(chosen)), cover_(std::move(cover)) {
    if (cover_.strength.empty()) cover_.strength.assign(chosen_.plants->species().size(), 1.0f);
  }

  void fill(const NodeBlock& block, float* values) const override {
    std::fill_n(values, nodes, 1.0f);  // what is left open
    splat(
        chosen_, block, values, [this](float radius) { return radius + cover_.reach_m; },
        [this](float& open, float squared, const Stem& stem) {
          open *= 1 - cover_.strength[stem.species] * crown_cover_at(std::sqrt(squared), stem.radius_m, cover_);
        });
    for (std::size_t i = 0; i < nodes; ++i) values[i] = 1 - values[i];
  }

  Range range(const Box& box) const override {
    return {0, any_within(chosen_, box, [this](float radius) { return radius + cover_.reach_m; }) ? 1.0f : 0.0f};
  }

 private:
  Chosen chosen_;
  CrownCover cover_;
};

class DistanceFiller final : public Filler {
 public:
  DistanceFiller(Chosen chosen, float most_m) : chosen_(std::move(chosen)), most_m_(most_m) {}

  void fill(const NodeBlock& block, float* values) const override {
    std::fill_n(values, nodes, most_m_ * most_m_);
    splat(
        chosen_, block, values, [this](float) { return most_m_; },
        [](float& least, float squared, const Stem&) { least = std::min(least, squared); });
    for (std::size_t i = 0; i < nodes; ++i) values[i] = std::min(std::sqrt(values[i]), most_m_);
  }

  Range range(const Box& box) const override {
    return {any_within(chosen_, box, [this](float) { return most_m_; }) ? 0 : most_m_, most_m_};
  }

 private:
  Chosen chosen_;
  float most_m_;
};

class DensityFiller final : public Filler {
 public:
  DensityFiller(Chosen chosen, float radius_m, DensityMeasure measure)
      : chosen_(std::move(chosen)), radius_m_(radius_m), measure_(measure) {
    // A place counts the stems of all tile positions that its disc may touch.
    const double r = static_cast<double>(radius_m);
    for (std::size_t l = 0; l < chosen_.plants->layer_count(); ++l) {
      const Selection::Layer& layer = chosen_.selection.layers[l];
      const double beside = std::floor(2 * r / chosen_.plants->ecosystem().layers[l].tile_set.side_m) + 2;
      const double each =
          measure == DensityMeasure::stems ? static_cast<double>(layer.most_plants) : layer.most_basal_area_m2;
      most_ += static_cast<float>(1.001 * beside * beside * each * peak());
    }
  }

  void fill(const NodeBlock& block, float* values) const override {
    std::fill_n(values, nodes, 0.0f);
    const float narrow = 1 / (radius_m_ * radius_m_);
    const auto top = static_cast<float>(peak());
    splat(
        chosen_, block, values, [this](float) { return radius_m_; },
        [&](float& sum, float squared, const Stem& stem) {
          const float thick = chosen_.plants->stem_radius_m(stem);
          const float weight = measure_ == DensityMeasure::stems ? top : top * static_cast<float>(pi) * thick * thick;
          sum += weight * std::max(0.0f, 1 - squared * narrow);
        });
  }

  Range range(const Box& box) const override {
    return {0, any_within(chosen_, box, [this](float) { return radius_m_; }) ? most_ : 0.0f};
  }

 private:
  // What a stem adds where it stands.
  double peak() const {
    const double r = static_cast<double>(radius_m_);
    return hectare_m2 * 2 / (pi * r * r);
  }

  Chosen chosen_;
  float radius_m_;
  DensityMeasure measure_;
  float most_ = 0;
};

}  // namespace

float crown_cover_at(float distance_m, float radius_m, const CrownCover& cover) {
  const float inner = radius_m * (1 - cover.rim), outer = radius_m + cover.reach_m;
  if (distance_m <= inner) return 1;
  if (distance_m >= outer) return 0;
  const float t = (distance_m - inner) / (outer - inner);
  return 1 - t * t * (3 - 2 * t);
}

std::unique_ptr<const Filler> crown_cover(Chosen chosen, CrownCover cover) {
  return std::make_unique<CrownFiller>(std::move(chosen), std::move(cover));
}

std::unique_ptr<const Filler> stem_distance(Chosen chosen, float most_m) {
  return std::make_unique<DistanceFiller>(std::move(chosen), most_m);
}

std::unique_ptr<const Filler> stand_density(Chosen chosen, float radius_m, DensityMeasure measure) {
  return std::make_unique<DensityFiller>(std::move(chosen), radius_m, measure);
}

}  // namespace ghosttile::cover
