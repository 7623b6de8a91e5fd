#include "silvasim/evaluators/suitability_map.h"

#include <algorithm>
#include <cmath>

#include "silvasim/base/parallel.h"

namespace silvasim::evaluators {

namespace {

constexpr double most_cells_across = 1000, sites_a_cell = 3;
constexpr std::uint32_t full = 254;  // what the map holds for probability 1

// Probabilities are summed as integers: no order of summation changes the sum.
constexpr float unit = 1 << 20;

// The next number of two digits: 8.4 for 8.37.
double rounded_up(double length_m) {
  const double step = std::pow(10.0, std::floor(std::log10(length_m)) - 1);
  return std::ceil(length_m / step - 1e-9) * step;
}

double cell_side_m(const base::Box& extent, std::uint64_t sites) {
  const double longer = std::max(extent.width(), extent.height());
  const double area = extent.width() * extent.height();
  const double wanted = sites > 0 ? std::sqrt(area * sites_a_cell / static_cast<double>(sites)) : longer;
  return rounded_up(std::clamp(wanted, longer / most_cells_across, longer));
}

int cells_along(double length_m, double cell_m) {
  return std::max(1, static_cast<int>(std::ceil(length_m / cell_m - 1e-6)));
}

// Rows of cells [first, last), while they are summed.
struct Band {
  int first = 0, last = 0;
  std::vector<std::uint64_t> sums;   // cell * species + s
  std::vector<std::uint64_t> sites;  // a cell
};

void sum_sites(const Suitability& suitability, const Ground& ground, const ecosystem::SuitabilityMap& map, Band& band) {
  const std::size_t species = suitability.species;
  const double side = ground.tile_set.side_m;
  const base::Box extent = ground.fields.frame.extent;
  // A tile row more on both sides, so that no rounding leaves a site out.
  const auto tile_row = [&](int cell_row) {
    return static_cast<int>(std::floor((ground.north_west.y - map.north + cell_row * map.cell_m) / side));
  };
  const int first_row = std::max(0, tile_row(band.first) - 1);
  const int last_row = std::min(ground.tiling.rows, tile_row(band.last) + 2);
  for (int row = first_row; row < last_row; ++row) {
    for (int column = 0; column < ground.tiling.columns; ++column) {
      const std::size_t position = ground.tiling.position(column, row);
      const double west = ground.north_west.x + column * side, south = ground.north_west.y - (row + 1) * side;
      const float* probability = suitability.probability.data() + ground.offsets[position] * species;
      for (const tiles::Site& site : ground.tile_set.tiles[ground.tiling.tiles[position]].sites) {
        const base::Point at{west + static_cast<double>(site.x_m), south + static_cast<double>(site.y_m)};
        const float* const here = probability;
        probability += species;
        if (!extent.contains(at)) continue;
        const int cell_row = std::min(map.rows - 1, static_cast<int>((map.north - at.y) / map.cell_m));
        if (cell_row < band.first || cell_row >= band.last) continue;
        const int cell_column = std::min(map.columns - 1, static_cast<int>((at.x - map.west) / map.cell_m));
        const auto cell = static_cast<std::size_t>(cell_row - band.first) * static_cast<std::size_t>(map.columns) +
                          static_cast<std::size_t>(cell_column);
        ++band.sites[cell];
        std::uint64_t* const sums = band.sums.data() + cell * species;
        for (std::size_t s = 0; s < species; ++s) {
          sums[s] += static_cast<std::uint32_t>(std::max(here[s], 0.0f) * unit + 0.5f);
        }
      }
    }
  }
}

}  // namespace

ecosystem::SuitabilityMap map_suitability(const Suitability& suitability, const Ground& ground) {
  ecosystem::SuitabilityMap map;
  const std::size_t species = suitability.species;
  if (species == 0) return map;
  const base::Box extent = ground.fields.frame.extent;
  map.west = extent.west;
  map.north = extent.north;
  map.cell_m = cell_side_m(extent, suitability.inside);
  map.columns = cells_along(extent.width(), map.cell_m);
  map.rows = cells_along(extent.height(), map.cell_m);
  const auto columns = static_cast<std::size_t>(map.columns), cells = columns * static_cast<std::size_t>(map.rows);
  map.shares.assign(cells * species, ecosystem::SuitabilityMap::no_site);

  // Each thread sums bands of cell rows of its own.
  const int rows_a_band = (map.rows + 63) / 64;
  base::parallel_for(static_cast<std::size_t>((map.rows + rows_a_band - 1) / rows_a_band), [&](std::size_t b) {
    Band band;
    band.first = static_cast<int>(b) * rows_a_band;
    band.last = std::min(map.rows, band.first + rows_a_band);
    const std::size_t count = static_cast<std::size_t>(band.last - band.first) * columns;
    band.sums.assign(count * species, 0);
    band.sites.assign(count, 0);
    sum_sites(suitability, ground, map, band);
    const std::size_t first = static_cast<std::size_t>(band.first) * columns;
    for (std::size_t cell = 0; cell < count; ++cell) {
      if (band.sites[cell] == 0) continue;
      const std::uint64_t whole = band.sites[cell] * static_cast<std::uint64_t>(unit);
      for (std::size_t s = 0; s < species; ++s) {
        const std::uint64_t share = (band.sums[cell * species + s] * full + whole / 2) / whole;
        map.shares[s * cells + first + cell] = static_cast<std::uint8_t>(std::min<std::uint64_t>(share, full));
      }
    }
  });
  return map;
}

}  // namespace silvasim::evaluators
