#include "silvasim/population/population.h"

#include <atomic>

#include "silvasim/base/parallel.h"
#include "silvasim/base/random.h"
#include "silvasim/population/choice.h"

namespace silvasim::population {

namespace {

ecosystem::PlantId most_likely(const float* probability, std::size_t species) {
  std::size_t best = 0;
  for (std::size_t s = 1; s < species; ++s) {
    if (probability[s] > probability[best]) best = s;
  }
  return probability[best] > 0 ? static_cast<ecosystem::PlantId>(best) : ecosystem::no_plant;
}

ecosystem::PlantId drawn_in_proportion(const float* probability, std::size_t species, float draw) {
  float sum = 0;
  for (std::size_t s = 0; s < species; ++s) sum += probability[s] > 0 ? probability[s] : 0.0f;
  float left = draw * sum;
  ecosystem::PlantId last = ecosystem::no_plant;
  for (std::size_t s = 0; s < species; ++s) {
    if (!(probability[s] > 0)) continue;
    last = static_cast<ecosystem::PlantId>(s);
    left -= probability[s];
    if (left < 0) break;
  }
  return last;
}

}  // namespace

Choice choose(const float* probability, std::size_t species, config::Selection selection, config::Chance chance,
              std::uint64_t seed, SiteKey key) {
  Choice choice;
  choice.candidate = most_likely(probability, species);
  if (choice.candidate == ecosystem::no_plant) return choice;
  if (selection == config::Selection::weighted) {
    const float draw = base::uniform_at(seed, base::Purpose::selection, key.column, key.row, key.site);
    choice.candidate = drawn_in_proportion(probability, species, draw);
  }
  choice.probability = probability[choice.candidate];
  choice.stands = chance == config::Chance::certain || base::uniform_at(seed, base::Purpose::establishment, key.column,
                                                                        key.row, key.site) < choice.probability;
  return choice;
}

std::uint64_t layer_seed(std::uint64_t seed, std::size_t layer) { return seed + layer * 0x9E3779B97F4A7C15u; }

Population establish(const evaluators::Suitability& suitability, const evaluators::Ground& ground,
                     const config::LayerSettings& layer, std::uint64_t seed, const base::Progress& progress) {
  Population population;
  const std::uint64_t sites = ground.offsets.back();
  population.plants.assign(sites, ecosystem::no_plant);
  population.candidates.assign(sites, ecosystem::no_plant);
  population.probability.assign(sites, 0.0f);
  const int columns = ground.tiling.columns, rows = ground.tiling.rows;
  std::atomic<int> done{0};
  base::parallel_for(static_cast<std::size_t>(rows), [&](std::size_t row) {
    for (int column = 0; column < columns; ++column) {
      const std::size_t position = ground.tiling.position(column, static_cast<int>(row));
      for (std::uint64_t i = ground.offsets[position]; i < ground.offsets[position + 1]; ++i) {
        const SiteKey key{static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row),
                          static_cast<std::uint32_t>(i - ground.offsets[position])};
        const Choice choice = choose(suitability.probability.data() + i * suitability.species, suitability.species,
                                     layer.selection, layer.chance, seed, key);
        population.probability[i] = choice.probability;
        population.candidates[i] = choice.candidate;
        if (choice.stands) population.plants[i] = choice.candidate;
      }
    }
    if (row % 8 == 0) base::report(progress, "establish", static_cast<double>(++done) * 8 / rows);
  });
  return population;
}

}  // namespace silvasim::population
