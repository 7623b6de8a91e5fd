// The field of neighbourhood of a plant: how strongly it acts on what stands at a distance.
//
// Source: Berger and Hildenbrandt 2000, equation 1: 1 within the stem's radius, then exp(-c (d - stem)) with c such that
// the field is Fmin at the rim R, and 0 beyond.
#pragma once

#include <vector>

#include "silvasim/base/math.h"
#include "silvasim/config/scenario.h"

namespace silvasim::population {

struct InfluenceField {
  float reach_m = 0;  // R
  float stem_m = 0;
  float decay = 0;  // c, 1/m

  // 0 beyond the reach.
  float at(float distance_m) const {
    if (distance_m > reach_m) return 0;
    return distance_m <= stem_m ? 1.0f : base::exp(-decay * (distance_m - stem_m));
  }
};

// What each species of a layer does to the others.
class Influences {
 public:
  explicit Influences(const config::LayerSettings& layer);

  // The field of a plant of the species on a site of that radius. Reach and stem grow with the plant's scale.
  InfluenceField field(std::size_t species, float site_radius_m) const {
    const Kind& kind = kinds_[species];
    const float scale = site_radius_m * kind.reciprocal_model_radius;
    const float reach = kind.reach_m * scale, stem = kind.stem_m * scale;
    return {reach, stem, kind.decay_metres / (reach - stem)};
  }

  // I[species][*], one value a species of the layer.
  const float* on_others(std::size_t species) const { return matrix_.data() + species * kinds_.size(); }

  // Whether the species acts on any other at all.
  bool acts(std::size_t species) const { return kinds_[species].acts; }

  // The largest reach any plant can have on sites up to that radius.
  float most_reach(float most_site_radius_m) const;

 private:
  struct Kind {
    float reach_m = 0, stem_m = 0, reciprocal_model_radius = 0;
    float decay_metres = 0;  // -ln Fmin
    bool acts = false;
  };
  std::vector<Kind> kinds_;
  std::vector<float> matrix_;
};

}  // namespace silvasim::population
