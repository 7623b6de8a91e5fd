#include "silvasim/population/neighbourhood_block.h"

#include <algorithm>
#include <cmath>

namespace silvasim::population {

namespace {

constexpr std::size_t nobody = ~std::size_t{0};

// 1 - 0.3 F and the like, never below 0, and the result within [0,1]. Excluded species (negative) stay excluded.
void weigh(float* probability, const float* influence, float strength, std::size_t species) {
  for (std::size_t s = 0; s < species; ++s) {
    const float factor = std::max(0.0f, 1.0f + influence[s] * strength);
    const float weighed = std::min(probability[s] * factor, 1.0f);
    probability[s] = probability[s] < 0 ? probability[s] : weighed;
  }
}

}  // namespace

NeighbourhoodBlock::Result NeighbourhoodBlock::run(int column, int row, int pass, Population& population) {
  const BlockLayout& layout = shared_.layout;
  origin_.first_column = column * layout.block_tiles;
  origin_.first_row = row * layout.block_tiles;
  origin_.last_column = std::min(origin_.first_column + layout.block_tiles, shared_.ground.tiling.columns);
  origin_.last_row = std::min(origin_.first_row + layout.block_tiles, shared_.ground.tiling.rows);

  population_ = &population;
  load(pass);
  weigh_surroundings();
  surrounded_ = probability_;
  if (pass > 0) weigh_last_pass();
  for (std::size_t i = 0; i < x_.size(); ++i) update(i);
  const Result result =
      fix_all(base::Stream(shared_.seed, base::Purpose::neighbourhood, static_cast<std::uint32_t>(column),
                           static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(pass)),
              pass);
  store(population);
  return result;
}

template <typename Visit>
void NeighbourhoodBlock::for_sites_of_tile(int column, int row, Visit&& visit) const {
  const evaluators::Ground& ground = shared_.ground;
  const auto side = static_cast<float>(ground.tile_set.side_m);
  const std::size_t position = ground.tiling.position(column, row);
  const auto& sites = ground.tile_set.tiles[ground.tiling.tiles[position]].sites;
  const float west = static_cast<float>(column - origin_.first_column) * side;
  const float north = static_cast<float>(row - origin_.first_row) * side;
  for (std::size_t k = 0; k < sites.size(); ++k) {
    visit(west + sites[k].x_m, north + (side - sites[k].y_m), sites[k].radius_m, ground.offsets[position] + k,
          static_cast<std::uint32_t>(k));
  }
}

void NeighbourhoodBlock::load(int pass) {
  const std::size_t species = shared_.suitability.species;
  const int cells = shared_.layout.cells;
  const auto cell_m = static_cast<float>(shared_.layout.cell_m);

  // Count the sites a cell, then put each into its cell, in the order of the tiling.
  struct Found {
    float x, y, radius;
    std::uint32_t cell;
    std::uint64_t index;
    SiteKey key;
  };
  std::vector<Found> found;
  cell_start_.assign(static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells) + 1, 0);
  for (int row = origin_.first_row; row < origin_.last_row; ++row) {
    for (int column = origin_.first_column; column < origin_.last_column; ++column) {
      for_sites_of_tile(column, row, [&](float x, float y, float radius, std::uint64_t index, std::uint32_t site) {
        const int i = std::clamp(static_cast<int>(x / cell_m), 0, cells - 1);
        const int j = std::clamp(static_cast<int>(y / cell_m), 0, cells - 1);
        const auto cell =
            static_cast<std::uint32_t>(j) * static_cast<std::uint32_t>(cells) + static_cast<std::uint32_t>(i);
        ++cell_start_[cell + 1];
        found.push_back(
            {x, y, radius, cell, index, {static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row), site}});
      });
    }
  }
  for (std::size_t c = 1; c < cell_start_.size(); ++c) cell_start_[c] += cell_start_[c - 1];

  const std::size_t count = found.size();
  for (auto* column : {&x_, &y_, &radius_m_, &certainty_, &chosen_}) column->resize(count);
  index_.resize(count);
  key_.resize(count);
  probability_.resize(count * species);
  last_plant_.resize(count);
  candidate_.assign(count, ecosystem::no_plant);
  std::vector<std::uint32_t> next(cell_start_.begin(), cell_start_.end() - 1);
  for (const Found& site : found) {
    const std::size_t i = next[site.cell]++;
    x_[i] = site.x;
    y_[i] = site.y;
    radius_m_[i] = site.radius;
    index_[i] = site.index;
    key_[i] = site.key;
    certainty_[i] = 0;
    chosen_[i] = 0;
    last_plant_[i] = population_->plants[site.index];
    std::copy_n(shared_.suitability.probability.data() + site.index * species, species,
                probability_.data() + i * species);
  }
  // In the first pass nobody stands yet; later the last pass's plants stand until their site is fixed anew.
  if (pass == 0) {
    plant_.assign(count, ecosystem::no_plant);
  } else {
    plant_ = last_plant_;
  }
}

template <typename Visit>
void NeighbourhoodBlock::for_plants_around(Visit&& visit) const {
  const evaluators::Ground& ground = shared_.ground;
  const auto side = static_cast<float>(ground.tile_set.side_m);
  const float reach = shared_.most_reach_m;
  if (reach <= 0) return;
  const int margin = static_cast<int>(std::ceil(reach / side));
  const float width = static_cast<float>(origin_.last_column - origin_.first_column) * side;
  const float height = static_cast<float>(origin_.last_row - origin_.first_row) * side;
  const int first_row = std::max(0, origin_.first_row - margin);
  const int last_row = std::min(ground.tiling.rows, origin_.last_row + margin);
  const int first_column = std::max(0, origin_.first_column - margin);
  const int last_column = std::min(ground.tiling.columns, origin_.last_column + margin);
  for (int row = first_row; row < last_row; ++row) {
    for (int column = first_column; column < last_column; ++column) {
      const bool inside = row >= origin_.first_row && row < origin_.last_row && column >= origin_.first_column &&
                          column < origin_.last_column;
      if (inside) continue;
      for_sites_of_tile(column, row, [&](float x, float y, float radius, std::uint64_t index, std::uint32_t) {
        if (x < -reach || y < -reach || x > width + reach || y > height + reach) return;
        const ecosystem::PlantId plant = population_->plants[index];
        if (plant != ecosystem::no_plant) visit(x, y, radius, plant, index);
      });
    }
  }
}

// Plants of other blocks act on this one: those fixed before it in this pass, and the others of the last pass.
void NeighbourhoodBlock::weigh_surroundings() {
  for_plants_around([&](float x, float y, float radius, ecosystem::PlantId plant, std::uint64_t) {
    act(x, y, radius, plant, nobody);
  });
}

void NeighbourhoodBlock::weigh_last_pass() {
  for (std::size_t i = 0; i < x_.size(); ++i) {
    if (plant_[i] != ecosystem::no_plant) act(x_[i], y_[i], radius_m_[i], plant_[i], i);
  }
}

std::pair<int, int> NeighbourhoodBlock::cells_between(float from, float to) const {
  const auto cell = static_cast<float>(shared_.layout.cell_m);
  const int last = shared_.layout.cells - 1;
  if (to < 0 || from > static_cast<float>(last + 1) * cell) return {1, 0};
  return {std::clamp(static_cast<int>(from / cell), 0, last), std::clamp(static_cast<int>(to / cell), 0, last)};
}

template <typename Visit>
void NeighbourhoodBlock::for_sites_near(float x, float y, float reach, Visit&& visit) const {
  const auto [west, east] = cells_between(x - reach, x + reach);
  const auto [north, south] = cells_between(y - reach, y + reach);
  const float square = reach * reach;
  if (west > east) return;
  for (int j = north; j <= south; ++j) {
    const auto row = static_cast<std::size_t>(j) * static_cast<std::size_t>(shared_.layout.cells);
    const std::uint32_t end = cell_start_[row + static_cast<std::size_t>(east) + 1];
    for (std::uint32_t i = cell_start_[row + static_cast<std::size_t>(west)]; i < end; ++i) {
      const float dx = x_[i] - x, dy = y_[i] - y;
      const float distance2 = dx * dx + dy * dy;
      if (distance2 <= square) visit(i, distance2);
    }
  }
}

void NeighbourhoodBlock::act(float x, float y, float radius_m, ecosystem::PlantId species, std::size_t self) {
  if (!shared_.influences.acts(species)) return;
  const InfluenceField field = shared_.influences.field(species, radius_m);
  const float* influence = shared_.influences.on_others(species);
  const std::size_t count = shared_.suitability.species;
  for_sites_near(x, y, field.reach_m, [&](std::size_t i, float distance2) {
    if (i == self || certainty_[i] < 0) return;
    weigh(probability_.data() + i * count, influence, field.at(std::sqrt(distance2)), count);
    update(i);
  });
}

// A plant changed at (x, y): weigh the unfixed sites that it could reach from the beginning.
void NeighbourhoodBlock::weigh_again(float x, float y) {
  const std::size_t count = shared_.suitability.species;
  for_sites_near(x, y, shared_.most_reach_m, [&](std::size_t i, float) {
    if (certainty_[i] < 0) return;
    float* probability = probability_.data() + i * count;
    std::copy_n(surrounded_.data() + i * count, count, probability);
    for_sites_near(x_[i], y_[i], shared_.most_reach_m, [&](std::size_t k, float distance2) {
      if (k == i || plant_[k] == ecosystem::no_plant || !shared_.influences.acts(plant_[k])) return;
      const float strength = shared_.influences.field(plant_[k], radius_m_[k]).at(std::sqrt(distance2));
      if (strength > 0) weigh(probability, shared_.influences.on_others(plant_[k]), strength, count);
    });
    update(i);
  });
}

// Certainty: the best probability less the second best, which is 0 where there is no second.
void NeighbourhoodBlock::update(std::size_t site) {
  const std::size_t count = shared_.suitability.species;
  const float* probability = probability_.data() + site * count;
  float best = 0, second = 0;
  for (std::size_t s = 0; s < count; ++s) {
    const float p = probability[s];
    second = std::max(second, std::min(best, p));
    best = std::max(best, p);
  }
  certainty_[site] = best - second;
}

NeighbourhoodBlock::Result NeighbourhoodBlock::fix_all(base::Stream stream, int pass) {
  Result result;
  const std::size_t cells = cell_start_.size() - 1;
  unfixed_.resize(cells);
  live_.clear();
  for (std::size_t c = 0; c < cells; ++c) {
    unfixed_[c] = cell_start_[c + 1] - cell_start_[c];
    if (unfixed_[c] > 0) live_.push_back(static_cast<std::uint32_t>(c));
  }
  // Algorithm 2, with the cell drawn among those that still hold unfixed sites (docs/reading.md, C1).
  while (!live_.empty()) {
    const std::uint32_t drawn = stream.next_below(static_cast<std::uint32_t>(live_.size()));
    const std::uint32_t cell = live_[drawn];
    std::size_t most_certain = cell_start_[cell];
    for (std::size_t i = most_certain + 1; i < cell_start_[cell + 1]; ++i) {
      if (certainty_[i] > certainty_[most_certain]) most_certain = i;
    }
    fix(most_certain, pass, result);
    if (--unfixed_[cell] == 0) {
      live_[drawn] = live_.back();
      live_.pop_back();
    }
  }
  return result;
}

void NeighbourhoodBlock::fix(std::size_t site, int pass, Result& result) {
  const std::size_t count = shared_.suitability.species;
  const Choice choice = choose(probability_.data() + site * count, count, shared_.layer.selection, shared_.layer.chance,
                               shared_.seed, key_[site]);
  if (shared_.watch == index_[site]) result.acting = acting_on(site);
  certainty_[site] = -1;
  chosen_[site] = choice.probability;
  candidate_[site] = choice.candidate;
  plant_[site] = choice.stands ? choice.candidate : ecosystem::no_plant;
  ++result.fixings;
  const bool changed = plant_[site] != (pass == 0 ? ecosystem::no_plant : last_plant_[site]);
  if (!changed) return;
  ++result.changed;
  if (pass == 0) {
    act(x_[site], y_[site], radius_m_[site], plant_[site], site);
  } else if (shared_.most_reach_m > 0) {
    weigh_again(x_[site], y_[site]);
  }
}

// Those whose influence is in the site's current probabilities.
std::vector<ActingPlant> NeighbourhoodBlock::acting_on(std::size_t site) const {
  std::vector<ActingPlant> acting;
  const auto add = [&](float x, float y, float radius_m, ecosystem::PlantId plant, std::uint64_t index) {
    if (!shared_.influences.acts(plant)) return;
    const float dx = x - x_[site], dy = y - y_[site], distance = std::sqrt(dx * dx + dy * dy);
    const float strength = shared_.influences.field(plant, radius_m).at(distance);
    if (strength > 0) acting.push_back({index, plant, distance, strength});
  };
  for_plants_around(add);
  for (std::size_t i = 0; i < x_.size(); ++i) {
    if (i != site && plant_[i] != ecosystem::no_plant) add(x_[i], y_[i], radius_m_[i], plant_[i], index_[i]);
  }
  return acting;
}

void NeighbourhoodBlock::store(Population& population) const {
  for (std::size_t i = 0; i < index_.size(); ++i) {
    population.plants[index_[i]] = plant_[i];
    population.candidates[index_[i]] = candidate_[i];
    population.probability[index_[i]] = chosen_[i];
  }
}

}  // namespace silvasim::population
