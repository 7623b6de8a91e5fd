#include "silvasim/evaluators/suitability.h"

#include <algorithm>
#include <atomic>

#include "silvasim/base/parallel.h"

namespace silvasim::evaluators {

namespace {

// Tile positions are handed out in runs of about this many sites: long enough to fill blocks, short enough to balance.
constexpr std::size_t run_sites = 8 * block_size;

std::vector<std::size_t> runs_of_positions(const std::vector<std::uint64_t>& offsets) {
  std::vector<std::size_t> starts{0};
  for (std::size_t p = 1; p + 1 < offsets.size(); ++p) {
    if (offsets[p] - offsets[starts.back()] >= run_sites) starts.push_back(p);
  }
  starts.push_back(offsets.size() - 1);
  return starts;
}

// Walks the sites of tile positions [first, last) in blocks.
template <typename Visit>
void for_each_block(const Ground& ground, std::size_t first, std::size_t last, SiteColumns& columns, Visit&& visit) {
  std::uint64_t start = ground.offsets[first];
  const auto flush = [&] {
    if (columns.x.empty()) return;
    visit(start);
    start += columns.x.size();
    columns.x.clear();
    columns.y.clear();
    columns.radius_m.clear();
  };
  for (std::size_t p = first; p < last; ++p) {
    const auto columns_of_tiling = static_cast<std::size_t>(ground.tiling.columns);
    const double side = ground.tile_set.side_m;
    const double west = ground.north_west.x + static_cast<double>(p % columns_of_tiling) * side;
    const double south = ground.north_west.y - static_cast<double>(p / columns_of_tiling + 1) * side;
    for (const tiles::Site& site : ground.tile_set.tiles[ground.tiling.tiles[p]].sites) {
      columns.x.push_back(west + static_cast<double>(site.x_m));
      columns.y.push_back(south + static_cast<double>(site.y_m));
      columns.radius_m.push_back(site.radius_m);
      if (columns.x.size() == block_size) flush();
    }
  }
  flush();
}

// Divides what is not excluded by `most`, which is the largest of it: the largest becomes exactly 1.
void divide(base::LazyVector<float>& probability, float most) {
  constexpr std::size_t piece = 1 << 18;
  base::parallel_for((probability.size() + piece - 1) / piece, [&](std::size_t k) {
    const std::size_t end = std::min(probability.size(), (k + 1) * piece);
    for (std::size_t i = k * piece; i < end; ++i) {
      const float p = probability[i];
      probability[i] = p > 0.0f ? p / most : p;
    }
  });
}

}  // namespace

void SiteColumns::sample(const Network& network, const fields::FieldSet& fields) {
  const std::size_t count = x.size();
  value.resize(network.fields().size());
  no_data.resize(network.fields().size());
  for (std::size_t k = 0; k < network.fields().size(); ++k) {
    const fields::Field& field = fields.fields[static_cast<std::size_t>(network.fields()[k])];
    value[k].resize(count);
    no_data[k].resize(count);
    fields::sample(field.raster, field.kind, x, y, value[k], no_data[k]);
    if (field.no_data == config::NoDataPolicy::fill) {
      for (std::size_t i = 0; i < count; ++i) value[k][i] = no_data[k][i] ? field.no_data_fill : value[k][i];
    }
  }
  const base::Box extent = fields.frame.extent;
  outside.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    outside[i] = (x[i] < extent.west) | (x[i] > extent.east) | (y[i] < extent.south) | (y[i] > extent.north);
  }
}

std::uint64_t SiteColumns::count_inside(const std::uint8_t* flagged) const {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < outside.size(); ++i) count += !outside[i] && (!flagged || flagged[i]);
  return count;
}

Network::Block SiteColumns::block() const {
  Network::Block block;
  block.count = x.size();
  block.radius_m = radius_m.data();
  for (std::size_t k = 0; k < value.size(); ++k) {
    block.value.push_back(value[k].data());
    const bool missing = std::find(no_data[k].begin(), no_data[k].end(), std::uint8_t{1}) != no_data[k].end();
    block.no_data.push_back(missing ? no_data[k].data() : nullptr);
  }
  return block;
}

Suitability evaluate_sites(const Network& network, const Ground& ground, const base::Progress& progress) {
  Suitability suitability;
  const std::size_t species = network.species();
  suitability.species = species;
  suitability.probability.resize(ground.offsets.back() * species);
  const std::vector<std::size_t> starts = runs_of_positions(ground.offsets);
  const std::size_t runs = starts.size() - 1;
  std::atomic<std::size_t> done{0};
  std::vector<std::atomic<std::uint64_t>> no_data(network.fields().size());
  std::atomic<std::uint64_t> inside{0};

  for (std::size_t stage = 0; stage < network.stages(); ++stage) {
    std::vector<float> most(runs, 0.0f);
    base::parallel_for(runs, [&](std::size_t r) {
      SiteColumns columns;
      Network::Scratch scratch;
      float largest = 0;
      for_each_block(ground, starts[r], starts[r + 1], columns, [&](std::uint64_t first) {
        columns.sample(network, ground.fields);
        float* probability = suitability.probability.data() + first * species;
        const Network::Block block = columns.block();
        network.run(stage, block, scratch, probability);
        if (stage == 0) {
          inside += columns.count_inside(nullptr);
          for (std::size_t k = 0; k < no_data.size(); ++k) {
            if (block.no_data[k]) no_data[k] += columns.count_inside(block.no_data[k]);
          }
        }
        for (std::size_t i = 0; i < columns.x.size(); ++i) {
          if (columns.outside[i]) std::fill_n(probability + i * species, species, excluded);
        }
        if (stage + 1 == network.stages()) return;
        for (std::size_t i = 0; i < columns.x.size() * species; ++i) largest = std::max(largest, probability[i]);
      });
      most[r] = largest;
      const double share = static_cast<double>(++done) / static_cast<double>(runs * network.stages());
      if (r % 16 == 0) base::report(progress, "evaluate", share);
    });
    if (stage + 1 == network.stages()) break;
    const float largest = *std::max_element(most.begin(), most.end());
    suitability.maxima.push_back(largest);
    if (largest > 0) divide(suitability.probability, largest);
  }
  suitability.inside = inside;
  suitability.no_data.assign(no_data.begin(), no_data.end());
  return suitability;
}

}  // namespace silvasim::evaluators
