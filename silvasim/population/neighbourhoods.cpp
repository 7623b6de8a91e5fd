#include "silvasim/population/neighbourhoods.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "silvasim/base/parallel.h"
#include "silvasim/population/neighbourhood_block.h"

namespace silvasim::population {

namespace {

constexpr int cells_a_block = 32;   // along a side (docs/reading.md, C5)
constexpr double sites_a_cell = 8;  // where the user names no cell size

double mean_sites_a_square_metre(const evaluators::Ground& ground) {
  const double area = ground.tile_set.side_m * ground.tile_set.side_m * static_cast<double>(ground.tiling.tiles.size());
  return static_cast<double>(ground.offsets.back()) / area;
}

// Cells divide a tile's side evenly, or are whole tiles, so that blocks of tiles are blocks of cells.
BlockLayout lay_out(const evaluators::Ground& ground, double cell_m, double reach_m, bool one_block) {
  BlockLayout layout;
  const double side = ground.tile_set.side_m;
  const double density = mean_sites_a_square_metre(ground);
  if (cell_m <= 0) cell_m = density > 0 ? std::sqrt(sites_a_cell / density) : side;
  const int across = std::max(ground.tiling.columns, ground.tiling.rows);
  int cells_a_tile = 0, tiles_a_cell = 1;
  if (cell_m <= side) {
    // A cell much smaller than a site holds none: it would cost memory and decide nothing.
    const double most_cells_a_tile = std::clamp(4 * side * std::sqrt(density), 1.0, 1024.0);
    cells_a_tile = static_cast<int>(std::clamp(std::round(side / cell_m), 1.0, most_cells_a_tile));
    layout.cell_m = side / cells_a_tile;
    layout.block_tiles = std::max(1, static_cast<int>(std::lround(static_cast<double>(cells_a_block) / cells_a_tile)));
  } else {
    tiles_a_cell = static_cast<int>(std::min(std::round(cell_m / side), static_cast<double>(across)));
    layout.cell_m = side * tiles_a_cell;
    layout.block_tiles = cells_a_block * tiles_a_cell;
  }
  // A plant must not reach beyond the blocks that touch its own; and one block may be asked for.
  while (layout.block_tiles * side < reach_m && layout.block_tiles < across) layout.block_tiles += tiles_a_cell;
  if (one_block || layout.block_tiles > across)
    layout.block_tiles = (across + tiles_a_cell - 1) / tiles_a_cell * tiles_a_cell;
  layout.cells = cells_a_tile > 0 ? layout.block_tiles * cells_a_tile : layout.block_tiles / tiles_a_cell;
  layout.columns = (ground.tiling.columns + layout.block_tiles - 1) / layout.block_tiles;
  layout.rows = (ground.tiling.rows + layout.block_tiles - 1) / layout.block_tiles;
  return layout;
}

}  // namespace

Competition compete(const evaluators::Suitability& suitability, const evaluators::Ground& ground,
                    const config::LayerSettings& layer, std::uint64_t seed, const NeighbourhoodOptions& options,
                    const base::Progress& progress) {
  const Influences influences(layer);
  const float reach = influences.most_reach(static_cast<float>(ground.tile_set.most_radius_m));
  const BlockLayout layout =
      lay_out(ground, layer.neighbourhoods.cell_m, static_cast<double>(reach), options.one_block);
  const CompetitionGround shared{suitability, ground, layer, influences, layout, seed, reach, options.watch};

  Competition competition;
  Population& population = competition.population;
  population.plants.assign(ground.offsets.back(), ecosystem::no_plant);
  population.candidates.assign(ground.offsets.back(), ecosystem::no_plant);
  population.probability.assign(ground.offsets.back(), 0.0f);
  NeighbourhoodReport& report = competition.report;
  report.cell_m = layout.cell_m;
  report.block_tiles = layout.block_tiles;

  tbb::enumerable_thread_specific<NeighbourhoodBlock> blocks([&] { return NeighbourhoodBlock(shared); });
  const auto total = static_cast<double>(layout.columns) * layout.rows * layer.neighbourhoods.passes;
  std::atomic<std::uint64_t> done{0};
  for (int pass = 0; pass < layer.neighbourhoods.passes; ++pass) {
    std::atomic<std::uint64_t> changed{0}, fixings{0};
    // Four colours: blocks of one colour have a block between them, so none reads what another writes.
    for (int colour = 0; colour < 4; ++colour) {
      const int first_column = colour % 2, first_row = colour / 2;
      const int columns = (layout.columns - first_column + 1) / 2, rows = (layout.rows - first_row + 1) / 2;
      base::parallel_for(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), [&](std::size_t k) {
        const int column = first_column + 2 * static_cast<int>(k % static_cast<std::size_t>(columns));
        const int row = first_row + 2 * static_cast<int>(k / static_cast<std::size_t>(columns));
        auto result = blocks.local().run(column, row, pass, population);
        if (result.acting) competition.acting = std::move(*result.acting);  // one block a pass holds the watched site
        changed += result.changed;
        fixings += result.fixings;
        base::report(progress, "neighbours", static_cast<double>(++done) / total);
      });
    }
    ++report.passes;
    report.changed.push_back(changed);
    report.fixings += fixings;
    if (pass > 0 && changed == 0) break;
  }
  return competition;
}

}  // namespace silvasim::population
