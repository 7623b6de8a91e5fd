#include "ghosttile/cover/plants.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "silvasim/base/parallel.h"

namespace ghosttile::cover {

namespace {

// Few enough that a question wastes little, enough that cells cost less than sites.
constexpr double sites_a_cell = 4;

// What the scenario says of a stem, else the usual share.
float stem_share(const silvasim::config::Scenario* scenario, const std::string& layer, const std::string& name) {
  if (!scenario) return Plants::usual_stem_per_height;
  for (const auto& settings : scenario->layers) {
    if (settings.name != layer) continue;
    for (const auto& species : settings.species) {
      if (species.name == name && species.height_m > 0) {
        return static_cast<float>(species.stem_radius_m / species.height_m);
      }
    }
  }
  return Plants::usual_stem_per_height;
}

}  // namespace

Plants::Plants(std::shared_ptr<const Ecosystem> ecosystem, const silvasim::config::Scenario* scenario)
    : ecosystem_(std::move(ecosystem)) {
  for (std::size_t l = 0; l < ecosystem_->layers.size(); ++l) {
    const silvasim::ecosystem::Layer& land = ecosystem_->layers[l];
    Layer layer;
    layer.first_species = static_cast<std::uint32_t>(species_.size());
    layer.offsets = silvasim::ecosystem::site_offsets(land.tile_set, land.tiling);
    for (const auto& species : land.species) {
      species_.push_back({species.name, l, species.height_m / species.model_radius_m,
                          stem_share(scenario, land.name, species.name), habit_of(species.name)});
    }
    for (const auto& tile : land.tile_set.tiles) {
      TileCells cells;
      cells.side = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(tile.sites.size()) / sites_a_cell)));
      const double cell = land.tile_set.side_m / cells.side;
      const auto cell_of = [&](const silvasim::tiles::Site& site) {
        const int u = std::clamp(static_cast<int>(static_cast<double>(site.x_m) / cell), 0, cells.side - 1);
        const int v = std::clamp(static_cast<int>(static_cast<double>(site.y_m) / cell), 0, cells.side - 1);
        return static_cast<std::size_t>(v) * static_cast<std::size_t>(cells.side) + static_cast<std::size_t>(u);
      };
      // Count, add up, put: sites keep their order within a cell.
      cells.first.assign(static_cast<std::size_t>(cells.side) * static_cast<std::size_t>(cells.side) + 1, 0);
      for (const auto& site : tile.sites) ++cells.first[cell_of(site) + 1];
      for (std::size_t i = 1; i < cells.first.size(); ++i) cells.first[i] += cells.first[i - 1];
      cells.sites.resize(tile.sites.size());
      std::vector<std::uint32_t> next(cells.first.begin(), cells.first.end() - 1);
      for (std::size_t s = 0; s < tile.sites.size(); ++s) {
        cells.sites[next[cell_of(tile.sites[s])]++] = static_cast<std::uint32_t>(s);
      }
      layer.tiles.push_back(std::move(cells));
    }
    layers_.push_back(std::move(layer));
  }
}

// Cells that [from, to] touches. A hair wider, because sites were put into cells with other rounding.
Plants::Span Plants::span(double from, double to, double cell, int count) {
  const double hair = 1e-6 * cell + 1e-6;
  const double first = std::floor((from - hair) / cell), last = std::floor((to + hair) / cell);
  if (!(first < count && last >= 0)) return {};
  return {static_cast<int>(std::max(first, 0.0)), static_cast<int>(std::min(last, count - 1.0))};
}

Selection Plants::select(std::vector<bool> species) const {
  Selection selection;
  selection.species = std::move(species);
  for (std::size_t l = 0; l < layers_.size(); ++l) {
    const silvasim::ecosystem::Layer& land = ecosystem_->layers[l];
    const Layer& layer = layers_[l];
    Selection::Layer found;
    found.occupied.assign(land.tiling.tiles.size(), false);
    std::mutex adding;
    silvasim::base::parallel_for(static_cast<std::size_t>(std::max(0, land.tiling.rows)), [&](std::size_t row) {
      const auto columns = static_cast<std::size_t>(land.tiling.columns);
      std::vector<bool> occupied(columns, false);
      float most_radius = 0;
      std::uint64_t most_plants = 0;
      double most_area = 0;
      for (std::size_t column = 0; column < columns; ++column) {
        const std::size_t position = row * columns + column;
        const auto& sites = land.tile_set.tiles[land.tiling.tiles[position]].sites;
        std::uint64_t plants = 0;
        double area = 0;
        for (std::size_t s = 0; s < sites.size(); ++s) {
          const silvasim::ecosystem::PlantId id = land.plants[layer.offsets[position] + s];
          if (id == silvasim::ecosystem::no_plant || !selection.species[layer.first_species + id]) continue;
          const double radius = static_cast<double>(stem_radius_m({0, 0, sites[s].radius_m, layer.first_species + id}));
          ++plants;
          area += 3.14159265358979 * radius * radius;
          most_radius = std::max(most_radius, sites[s].radius_m);
        }
        occupied[column] = plants > 0;
        most_plants = std::max(most_plants, plants);
        most_area = std::max(most_area, area);
      }
      const std::lock_guard lock(adding);
      for (std::size_t column = 0; column < columns; ++column)
        found.occupied[row * columns + column] = occupied[column];
      found.most_radius_m = std::max(found.most_radius_m, most_radius);
      found.most_plants = std::max(found.most_plants, most_plants);
      found.most_basal_area_m2 = std::max(found.most_basal_area_m2, most_area);
    });
    selection.layers.push_back(std::move(found));
  }
  return selection;
}

bool Plants::any(std::size_t l, const Box& box, const Selection& selection) const {
  const Selection::Layer& chosen = selection.layers[l];
  if (!(chosen.most_radius_m > 0)) return false;
  const silvasim::ecosystem::Layer& land = ecosystem_->layers[l];
  const double side = land.tile_set.side_m;
  // Positions that lie in the box whole need no look at their plants.
  const Span columns = span(box.west - land.north_west.x, box.east - land.north_west.x, side, land.tiling.columns);
  const Span rows = span(land.north_west.y - box.north, land.north_west.y - box.south, side, land.tiling.rows);
  for (int row = rows.first + 1; row < rows.last; ++row) {
    for (int column = columns.first + 1; column < columns.last; ++column) {
      if (chosen.occupied[land.tiling.position(column, row)]) return true;
    }
  }
  return !for_each(l, box, selection, [](const Stem&) { return false; });
}

}  // namespace ghosttile::cover
