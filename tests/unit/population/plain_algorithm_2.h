// Algorithm 2 of Silva 2013 a second way: plain loops over all pairs of sites, in doubles.
//
// Whenever a cell is drawn, the probabilities of its sites are worked out anew: the abiotic ones, weighed with every plant
// that stands at that moment. Nothing is kept from draw to draw but who stands. It knows docs/reading.md, C1 to C5, and
// what a seed means: a stream a block and pass; live cells are numbered row by row from the north, and when one is done
// the last takes its number; a site's own draws are keyed by its tile and id.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "silvasim/base/random.h"
#include "silvasim/population/neighbourhoods.h"

namespace silvasim::population {

// Metres from the land's north-west corner, y southward.
struct PlainSite {
  double x_m = 0, y_m = 0, radius_m = 0;
  int column = 0, row = 0;  // tile
  std::uint32_t id = 0;     // in the tile
};

// In the population's order.
inline std::vector<PlainSite> plain_sites(const evaluators::Ground& ground) {
  std::vector<PlainSite> all;
  const double side = ground.tile_set.side_m;
  for (int row = 0; row < ground.tiling.rows; ++row) {
    for (int column = 0; column < ground.tiling.columns; ++column) {
      std::uint32_t id = 0;
      for (const tiles::Site& site : ground.tile_set.tiles[ground.tiling.at(column, row)].sites) {
        all.push_back({column * side + static_cast<double>(site.x_m), (row + 1) * side - static_cast<double>(site.y_m),
                       static_cast<double>(site.radius_m), column, row, id++});
      }
    }
  }
  return all;
}

// F of Berger and Hildenbrandt 2000 (equation 1), written as a power of Fmin.
inline double plain_field(const config::SpeciesSettings& species, double fmin, double site_radius_m,
                          double distance_m) {
  const double scale = site_radius_m / species.model_radius_m;
  const double reach = species.fon_radius_m * scale, stem = species.stem_radius_m * scale;
  if (distance_m > reach) return 0;
  return distance_m <= stem ? 1 : std::pow(fmin, (distance_m - stem) / (reach - stem));
}

class PlainAlgorithm2 {
 public:
  std::vector<ecosystem::PlantId> plants, candidates;
  std::vector<double> probability;  // of the candidate, when its site was fixed

  PlainAlgorithm2(const evaluators::Suitability& suitability, const evaluators::Ground& ground,
                  const config::LayerSettings& layer, std::uint64_t seed)
      : suitability_(suitability), ground_(ground), layer_(layer), seed_(seed), sites_(plain_sites(ground)) {
    plants.assign(sites_.size(), ecosystem::no_plant);
    candidates = plants;
    probability.assign(sites_.size(), 0);
  }

  // The next pass, in blocks of block_tiles x block_tiles tiles. Returns how many plants changed.
  std::uint64_t pass(double cell_m, int block_tiles) {
    std::uint64_t changed = 0;
    std::vector<std::size_t> by_cell;
    for (int colour = 0; colour < 4; ++colour) {
      for (int row = colour / 2; row * block_tiles < ground_.tiling.rows; row += 2) {
        for (int column = colour % 2; column * block_tiles < ground_.tiling.columns; column += 2) {
          std::map<std::pair<int, int>, std::vector<std::size_t>> cells;  // by row, then column
          for (std::size_t i = 0; i < sites_.size(); ++i) {
            const PlainSite& site = sites_[i];
            if (site.column / block_tiles != column || site.row / block_tiles != row) continue;
            cells[{static_cast<int>(site.y_m / cell_m), static_cast<int>(site.x_m / cell_m)}].push_back(i);
          }
          for (const auto& [place, members] : cells) by_cell.insert(by_cell.end(), members.begin(), members.end());
          changed +=
              fix_block(cells, base::Stream(seed_, base::Purpose::neighbourhood, static_cast<std::uint32_t>(column),
                                            static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(passes_)));
        }
      }
    }
    acting_ = by_cell;
    ++passes_;
    return changed;
  }

 private:
  std::uint64_t fix_block(const std::map<std::pair<int, int>, std::vector<std::size_t>>& cells, base::Stream stream) {
    std::uint64_t changed = 0;
    std::vector<std::vector<std::size_t>> live;  // a cell: its unfixed sites
    for (const auto& [place, members] : cells) live.push_back(members);
    while (!live.empty()) {
      std::vector<std::size_t>& cell = live[stream.next_below(static_cast<std::uint32_t>(live.size()))];
      std::vector<double> certainties;
      for (const std::size_t site : cell) certainties.push_back(certainty(weighed(site)));
      const auto most_certain = std::max_element(certainties.begin(), certainties.end()) - certainties.begin();
      changed += fix(cell[static_cast<std::size_t>(most_certain)]);
      cell.erase(cell.begin() + most_certain);
      if (cell.empty()) {
        std::swap(cell, live.back());
        live.pop_back();
      }
    }
    return changed;
  }

  // The site's probabilities among all plants that stand now. Each step is kept within [0,1], so where some influences
  // help and others hinder their order counts: that of fixing in the first pass, then cell by cell.
  std::vector<double> weighed(std::size_t site) const {
    const std::size_t count = suitability_.species;
    const float* abiotic = suitability_.probability.data() + site * count;
    std::vector<double> p(abiotic, abiotic + count);
    for (const std::size_t k : acting_) {
      if (k == site || plants[k] == ecosystem::no_plant) continue;
      const double d = std::hypot(sites_[k].x_m - sites_[site].x_m, sites_[k].y_m - sites_[site].y_m);
      const double f = plain_field(layer_.species[plants[k]], layer_.neighbourhoods.fmin, sites_[k].radius_m, d);
      for (std::size_t s = 0; s < count && f > 0; ++s) {
        if (p[s] >= 0)
          p[s] = std::clamp(p[s] * (1 + layer_.neighbourhoods.influence[plants[k] * count + s] * f), 0., 1.);
      }
    }
    return p;
  }

  // Best less second best, which is 0 where there is none.
  static double certainty(std::vector<double> p) {
    p.insert(p.end(), 2, 0.0);
    std::sort(p.rbegin(), p.rend());
    return p[0] - p[1];
  }

  bool fix(std::size_t site) {
    const std::vector<double> p = weighed(site);
    const auto draw = [&](base::Purpose purpose) {
      const PlainSite& key = sites_[site];
      return static_cast<double>(base::uniform_at(seed_, purpose, static_cast<std::uint32_t>(key.column),
                                                  static_cast<std::uint32_t>(key.row), key.id));
    };
    auto best = std::max_element(p.begin(), p.end());
    if (*best > 0 && layer_.selection == config::Selection::weighted) {
      double left = draw(base::Purpose::selection), sum = 0;
      for (const double each : p) sum += std::max(each, 0.0);
      for (best = p.begin(); (left -= std::max(*best, 0.0) / sum) >= 0;) ++best;
    }
    const bool viable = *best > 0;
    const bool stands =
        viable && (layer_.chance == config::Chance::certain || draw(base::Purpose::establishment) < *best);
    const ecosystem::PlantId before = plants[site];
    candidates[site] = viable ? static_cast<ecosystem::PlantId>(best - p.begin()) : ecosystem::no_plant;
    plants[site] = stands ? candidates[site] : ecosystem::no_plant;
    probability[site] = viable ? *best : 0;
    if (passes_ == 0) acting_.push_back(site);
    return plants[site] != before;
  }

  const evaluators::Suitability& suitability_;
  const evaluators::Ground& ground_;
  const config::LayerSettings& layer_;
  std::uint64_t seed_;
  std::vector<PlainSite> sites_;
  std::vector<std::size_t> acting_;  // sites in the order in which their plants are weighed in
  int passes_ = 0;
};

}  // namespace silvasim::population
