#include "silvasim/population/influence_field.h"

#include <algorithm>

namespace silvasim::population {

Influences::Influences(const config::LayerSettings& layer) {
  const std::size_t count = layer.species.size();
  for (std::size_t s = 0; s < count; ++s) {
    const config::SpeciesSettings& species = layer.species[s];
    Kind kind;
    kind.reach_m = static_cast<float>(species.fon_radius_m);
    kind.stem_m = static_cast<float>(species.stem_radius_m);
    kind.reciprocal_model_radius = static_cast<float>(1 / species.model_radius_m);
    kind.decay_metres = -base::log(static_cast<float>(layer.neighbourhoods.fmin));
    for (std::size_t t = 0; t < count; ++t) {
      matrix_.push_back(static_cast<float>(layer.neighbourhoods.influence[s * count + t]));
      kind.acts = kind.acts || (matrix_.back() != 0 && kind.reach_m > kind.stem_m);
    }
    kinds_.push_back(kind);
  }
}

float Influences::most_reach(float most_site_radius_m) const {
  float most = 0;
  for (const Kind& kind : kinds_) {
    if (kind.acts) most = std::max(most, kind.reach_m * kind.reciprocal_model_radius * most_site_radius_m);
  }
  return most;
}

}  // namespace silvasim::population
