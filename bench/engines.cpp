// The engines against plain ways to the same result, in one run: read the ratios, not the times.
//
// evaluate: columns in blocks, against one site at a time through the same evaluators.
// compete: blocks in four colours, against the paper's one random-cell loop over the whole land.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "silvasim/config/load.h"
#include "silvasim/evaluators/trace.h"
#include "silvasim/pipeline.h"
#include "silvasim/tiles/fill.h"
#include "silvasim/tiles/tile_land.h"

namespace {

using namespace silvasim;

struct Land {
  config::Scenario scenario;
  fields::FieldSet fields;
  tiles::TileSet tile_set;
  tiles::Tiling tiling;
  std::vector<std::uint64_t> offsets;

  Land() {
    const auto file = std::filesystem::path(SILVA_SOURCE_DIR) / "bench" / "scenes" / "unisb-9km.xml";
    scenario = config::load_scenario(file, std::nullopt, evaluators::dialect());
    fields = fields::load_fields(scenario.scene, scenario.fields);
    tile_set = tiles::fill_tiles(scenario.layers[0].tiles, scenario.seed);
    tiling = tiles::tile_land(tile_set, 10, 10, scenario.seed);
    offsets = ecosystem::site_offsets(tile_set, tiling);
  }
  evaluators::Ground ground() const {
    return {tile_set, tiling, {fields.frame.extent.west, fields.frame.extent.north}, offsets, fields};
  }
};

const Land& land() {
  static const Land made;
  return made;
}

void evaluate_in_blocks(benchmark::State& state) {
  const evaluators::Network network(land().scenario, 0);
  for (auto _ : state) benchmark::DoNotOptimize(evaluators::evaluate_sites(network, land().ground()));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(land().offsets.back()));
}

void evaluate_site_by_site(benchmark::State& state) {
  const evaluators::Network network(land().scenario, 0);
  const evaluators::Suitability whole = evaluators::evaluate_sites(network, land().ground());
  const std::size_t sites = land().tile_set.tiles[land().tiling.tiles[0]].sites.size();
  for (auto _ : state) {
    for (std::size_t i = 0; i < sites; ++i) {
      const tiles::Site& site = land().tile_set.tiles[land().tiling.tiles[0]].sites[i];
      evaluators::SiteColumns one;
      one.x = {land().ground().north_west.x + static_cast<double>(site.x_m)};
      one.y = {land().ground().north_west.y - land().tile_set.side_m + static_cast<double>(site.y_m)};
      one.radius_m = {site.radius_m};
      one.sample(network, land().fields);
      benchmark::DoNotOptimize(evaluators::trace(network, land().scenario, one, whole.maxima));
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(sites));
}

void compete(benchmark::State& state, bool one_block) {
  const evaluators::Network network(land().scenario, 0);
  const evaluators::Suitability suitability = evaluators::evaluate_sites(network, land().ground());
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        population::compete(suitability, land().ground(), land().scenario.layers[0], 1, {one_block}));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(land().offsets.back()));
}

BENCHMARK(evaluate_in_blocks)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(evaluate_site_by_site)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(compete, in_blocks, false)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(compete, in_one_block, true)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
