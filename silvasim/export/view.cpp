#include "silvasim/export/view.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "silvasim/base/error.h"
#include "silvasim/base/parallel.h"
#include "silvasim/export/heat.h"

namespace silvasim::exports {

namespace {

constexpr double pi = 3.14159265358979323846;

std::string text(const base::Box& box) {
  return fmt::format("{:.10g} to {:.10g} east, {:.10g} to {:.10g} north", box.west, box.east, box.south, box.north);
}

// Marks the species that the user named; a name may stand for a species in several layers.
void choose(const ecosystem::Ecosystem& ecosystem, const PreviewOptions& options, Census& census) {
  if (options.species.empty()) return;
  std::vector<std::string> names;
  for (std::size_t l = 0; l < ecosystem.layers.size(); ++l) {
    for (std::size_t s = 0; s < ecosystem.layers[l].species.size(); ++s) {
      census.layers[l][s].shown = false;
      names.push_back(ecosystem.layers[l].species[s].name);
      if (!ecosystem.layers[l].species[s].common_name.empty())
        names.push_back(ecosystem.layers[l].species[s].common_name);
    }
  }
  for (const std::string& wanted : options.species) {
    bool found = false;
    for (std::size_t l = 0; l < ecosystem.layers.size(); ++l) {
      for (std::size_t s = 0; s < ecosystem.layers[l].species.size(); ++s) {
        const ecosystem::Species& species = ecosystem.layers[l].species[s];
        if (species.name != wanted && species.common_name != wanted) continue;
        census.layers[l][s].shown = true;
        found = true;
      }
    }
    if (found) continue;
    std::string hint = base::did_you_mean(wanted, names);
    if (hint.empty() && !names.empty()) hint = fmt::format("; it has \"{}\"", fmt::join(names, "\", \""));
    throw base::ConfigError({"--species"}, fmt::format("the ecosystem has no species \"{}\"{}", wanted, hint));
  }
}

void require(const ecosystem::Ecosystem& ecosystem, const Census& census, Subject subject) {
  if (subject == Subject::species) return;
  const bool maps = subject == Subject::suitability;
  for (std::size_t l = 0; l < ecosystem.layers.size(); ++l) {
    const ecosystem::Layer& layer = ecosystem.layers[l];
    const bool shown = std::any_of(census.layers[l].begin(), census.layers[l].end(), [](auto& c) { return c.shown; });
    const bool held = maps ? !layer.suitability.empty() : layer.plants.empty() || !layer.probabilities.empty();
    if (!shown || held) continue;
    throw base::ConfigError({"--layer"}, fmt::format("the ecosystem holds no {} for its layer \"{}\"; "
                                                     "simulate it again with: silvasim run ... --probabilities",
                                                     maps ? "suitability map" : "growth probabilities", layer.name));
  }
}

}  // namespace

base::Box box_of(const ecosystem::Ecosystem& ecosystem, const PreviewOptions& options) {
  const auto usable = [](const base::Box& box) {
    return !box.empty() && std::isfinite(box.width()) && std::isfinite(box.height());
  };
  if (!usable(ecosystem.extent)) throw base::Error("the ecosystem has an empty extent: there is nothing to show");
  if (!options.bbox) return ecosystem.extent;
  if (!usable(*options.bbox)) {
    throw base::ConfigError({"--bbox"},
                            "the box is empty; give west, south, east, north with west < east and south < north");
  }
  if (base::intersection(*options.bbox, ecosystem.extent).empty()) {
    throw base::ConfigError({"--bbox"}, fmt::format("the box ({}) lies beside the ecosystem ({})", text(*options.bbox),
                                                    text(ecosystem.extent)));
  }
  return *options.bbox;
}

Census take_census(const ecosystem::Ecosystem& ecosystem, const PreviewOptions& options, const base::Box& box) {
  Census census;
  for (const ecosystem::Layer& layer : ecosystem.layers) {
    census.layers.emplace_back(layer.species.size());
    census.offsets.push_back(ecosystem::site_offsets(layer.tile_set, layer.tiling));
  }
  choose(ecosystem, options, census);
  require(ecosystem, census, options.subject);

  double radius_sum = 0;
  for (std::size_t l = 0; l < ecosystem.layers.size(); ++l) {
    const ecosystem::Layer& layer = ecosystem.layers[l];
    // Sum by bands of tile rows, then add the bands in their order: the same sums whatever the threads.
    struct Sum {
      std::uint64_t plants = 0;
      double radius = 0, square = 0, probability = 0;
    };
    constexpr int band_rows = 16;
    const std::size_t bands = static_cast<std::size_t>((layer.tiling.rows + band_rows - 1) / band_rows);
    std::vector<std::vector<Sum>> sums(bands, std::vector<Sum>(layer.species.size()));
    base::parallel_for(bands, [&](std::size_t band) {
      const double side = layer.tile_set.side_m;
      const int first = static_cast<int>(band) * band_rows, last = std::min(first + band_rows, layer.tiling.rows);
      const double top = layer.north_west.y - first * side, bottom = layer.north_west.y - last * side;
      base::Box near = box;
      near.north = std::min(near.north, top);
      near.south = std::max(near.south, bottom);
      for_each_plant_near(layer, census.offsets[l], near, [&](const ecosystem::Plant& plant) {
        if (plant.row < first || plant.row >= last || !box.contains(plant.at)) return;
        Sum& sum = sums[band][plant.species];
        const double radius = static_cast<double>(plant.radius_m);
        ++sum.plants;
        sum.radius += radius;
        sum.square += radius * radius;
        sum.probability += static_cast<double>(plant.probability);
      });
    });
    for (std::size_t s = 0; s < layer.species.size(); ++s) {
      SpeciesCount& count = census.layers[l][s];
      double radius = 0;
      for (const auto& band : sums) {
        count.plants += band[s].plants;
        count.crown_area_m2 += pi * band[s].square;
        count.mean_probability += band[s].probability;
        radius += band[s].radius;
      }
      if (count.plants > 0) count.mean_probability /= static_cast<double>(count.plants);
      if (!count.shown) continue;
      if (options.subject == Subject::suitability) count.mean_suitability = mean_suitability(layer.suitability, s, box);
      census.plants += count.plants;
      radius_sum += radius;
    }
  }
  if (census.plants > 0) census.mean_radius_m = radius_sum / static_cast<double>(census.plants);
  return census;
}

}  // namespace silvasim::exports
