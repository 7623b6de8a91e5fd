#include "ghosttile/cover/lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "silvasim/base/vector_clones.h"

namespace ghosttile::cover {

NodeBlock::Span NodeBlock::span(double from, double to, std::int64_t first) const {
  const double low = std::floor(from / step_m) - static_cast<double>(first);
  const double high = std::ceil(to / step_m) - static_cast<double>(first);
  if (!(low <= block_cells && high >= 0)) return {0, -1};
  return {static_cast<int>(std::max(low, 0.0)), static_cast<int>(std::min<double>(high, block_cells))};
}

namespace {

struct Block {
  Range range;
  std::array<float, static_cast<std::size_t>(block_nodes) * block_nodes> values;
};
using BlockPointer = std::shared_ptr<const Block>;

struct Index {
  std::int64_t column = 0, row = 0;
  friend bool operator==(const Index&, const Index&) = default;
};
struct IndexHash {
  std::size_t operator()(const Index& index) const {
    std::uint64_t h = static_cast<std::uint64_t>(index.column) * 0x9E3779B97F4A7C15u;
    h = (h ^ (h >> 32) ^ static_cast<std::uint64_t>(index.row)) * 0xFF51AFD7ED558CCDu;
    return static_cast<std::size_t>(h ^ (h >> 33));
  }
};

// The oldest blocks go first.
struct Shard {
  std::mutex mutex;
  std::unordered_map<Index, BlockPointer, IndexHash> blocks;
  std::deque<Index> order;
};

constexpr int block_bits = 6;
static_assert(1 << block_bits == block_cells);
std::int64_t block_of(std::int64_t node) { return node >> block_bits; }

// floor, without a call where the machine has no instruction for it
std::int64_t whole_below(double x) {
  const auto whole = static_cast<std::int64_t>(x);
  return whole - (static_cast<double>(whole) > x ? 1 : 0);
}

// Bilinear, at places in cells within the block that begins at (west, south). Exact until the last step: a place less a whole number
// needs no more bits.
SILVA_VECTOR_CLONES void read(const float* nodes, double west, double south, const double* across, const double* along,
                              std::size_t count, float* value) {
  for (std::size_t i = 0; i < count; ++i) {
    const double a = across[i] - west, b = along[i] - south;
    const auto column = static_cast<std::int32_t>(a), row = static_cast<std::int32_t>(b);
    const auto u = static_cast<float>(a - column), v = static_cast<float>(b - row);
    const float* const four = nodes + (row * block_nodes + column);
    const float lower = four[0] + u * (four[1] - four[0]);
    const float upper = four[block_nodes] + u * (four[block_nodes + 1] - four[block_nodes]);
    value[i] = lower + v * (upper - lower);
  }
}

class Lattice final : public Source {
 public:
  Lattice(std::unique_ptr<const Filler> filler, double step_m, std::size_t most_bytes)
      : filler_(std::move(filler)),
        step_m_(step_m),
        nodes_a_metre_(1 / step_m),
        most_blocks_(std::max<std::size_t>(4, most_bytes / sizeof(Block) / shards_.size())) {}

  void sample(const V3d& origin, const float* x, const float* y, std::size_t count, float* value) const override {
    for (std::size_t done = 0; done < count; done += density::block_size) {
      sample_some(origin, x + done, y + done, std::min(count - done, density::block_size), value + done);
    }
  }

  SourceRange range(const silvasim::base::Box& box) const override {
    // A thousandth of a cell for the rounding of coordinates.
    const std::int64_t west = node_of(box.west - 1e-3 * step_m_), south = node_of(box.south - 1e-3 * step_m_),
                       east = node_of(box.east + 1e-3 * step_m_) + 1, north = node_of(box.north + 1e-3 * step_m_) + 1;
    const std::int64_t blocks = std::max(block_of(east) - block_of(west), block_of(north) - block_of(south)) + 1;
    // Small boxes are asked before their points are, so their blocks are needed anyway; large ones are empty or not.
    constexpr std::int64_t few = 2, most = 4;
    Range rough;
    if (blocks > few) rough = filler_->range(silvasim::base::grown(box, step_m_));
    if (blocks <= few || (blocks <= most && rough.least < rough.most)) rough = range_of_nodes(west, south, east, north);
    // Interpolation may round to just beside its nodes' values, if not where they are all the same or where it starts from 0.
    if (rough.least == rough.most) return {rough, false};
    const float hair = 1e-6f * std::max(std::fabs(rough.least), std::fabs(rough.most));
    return {{rough.least == 0 ? 0 : rough.least - hair, rough.most == 0 ? 0 : rough.most + hair}, false};
  }

 private:
  static constexpr double farthest = 1e15;  // in nodes: still whole numbers in a double

  double place(double origin, float offset) const {
    return std::clamp((origin + static_cast<double>(offset)) * nodes_a_metre_, -farthest, farthest);
  }

  std::int64_t node_of(double metres) const {
    return whole_below(std::clamp(metres * nodes_a_metre_, -farthest, farthest));
  }

  BlockPointer block_at(const Index& index) const {
    Shard& shard = shards_[IndexHash{}(index) % shards_.size()];
    {
      const std::lock_guard lock(shard.mutex);
      const auto found = shard.blocks.find(index);
      if (found != shard.blocks.end()) return found->second;
    }
    auto block = std::make_shared<Block>();
    filler_->fill({index.column * block_cells, index.row * block_cells, step_m_}, block->values.data());
    const auto [least, most] = std::minmax_element(block->values.begin(), block->values.end());
    block->range = {*least, *most};
    const std::lock_guard lock(shard.mutex);
    if (!shard.blocks.emplace(index, block).second) return block;
    shard.order.push_back(index);
    if (shard.order.size() > most_blocks_) {
      shard.blocks.erase(shard.order.front());
      shard.order.pop_front();
    }
    return block;
  }

  void sample_some(const V3d& origin, const float* x, const float* y, std::size_t count, float* value) const {
    std::array<double, density::block_size> across, along;  // in cells
    const double first_x = place(origin.x, x[0]), first_y = place(origin.y, y[0]);
    double west = first_x, east = first_x, south = first_y, north = first_y;
    for (std::size_t i = 0; i < count; ++i) {
      across[i] = place(origin.x, x[i]);
      along[i] = place(origin.y, y[i]);
      west = std::min(west, across[i]);
      east = std::max(east, across[i]);
      south = std::min(south, along[i]);
      north = std::max(north, along[i]);
    }
    const Index first{block_of(whole_below(west)), block_of(whole_below(south))};
    const Index last{block_of(whole_below(east)), block_of(whole_below(north))};
    if (first == last) {
      // Nearly always: points of a call lie beside each other.
      const BlockPointer block = block_at(first);
      read(block->values.data(), static_cast<double>(first.column * block_cells),
           static_cast<double>(first.row * block_cells), across.data(), along.data(), count, value);
      return;
    }
    // Remember a few blocks, or where points are spread the last one.
    constexpr std::int64_t side = 4;
    const bool near = last.column - first.column < side && last.row - first.row < side;
    std::array<BlockPointer, side * side> blocks;
    Index before = first;
    for (std::size_t i = 0; i < count; ++i) {
      const Index index{block_of(whole_below(across[i])), block_of(whole_below(along[i]))};
      BlockPointer& block =
          blocks[near ? static_cast<std::size_t>((index.row - first.row) * side + index.column - first.column) : 0];
      if (!block || (!near && !(index == before))) block = block_at(index);
      before = index;
      read(block->values.data(), static_cast<double>(index.column * block_cells),
           static_cast<double>(index.row * block_cells), &across[i], &along[i], 1, value + i);
    }
  }

  Range range_of_nodes(std::int64_t west, std::int64_t south, std::int64_t east, std::int64_t north) const {
    Range range{std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest()};
    for (std::int64_t row = block_of(south); row <= block_of(north); ++row) {
      for (std::int64_t column = block_of(west); column <= block_of(east); ++column) {
        const BlockPointer block = block_at({column, row});
        const auto i0 = std::max<std::int64_t>(west - column * block_cells, 0),
                   i1 = std::min<std::int64_t>(east - column * block_cells, block_cells),
                   j0 = std::max<std::int64_t>(south - row * block_cells, 0),
                   j1 = std::min<std::int64_t>(north - row * block_cells, block_cells);
        if (i0 == 0 && j0 == 0 && i1 == block_cells && j1 == block_cells) {
          range = {std::min(range.least, block->range.least), std::max(range.most, block->range.most)};
          continue;
        }
        for (std::int64_t j = j0; j <= j1; ++j) {
          for (std::int64_t i = i0; i <= i1; ++i) {
            const float value = block->values[static_cast<std::size_t>(j * block_nodes + i)];
            range = {std::min(range.least, value), std::max(range.most, value)};
          }
        }
      }
    }
    return range;
  }

  std::unique_ptr<const Filler> filler_;
  double step_m_, nodes_a_metre_;
  mutable std::array<Shard, 16> shards_;
  std::size_t most_blocks_;  // a shard
};

}  // namespace

std::shared_ptr<const Source> on_lattice(std::unique_ptr<const Filler> filler, double step_m, std::size_t most_bytes) {
  return std::make_shared<Lattice>(std::move(filler), step_m, most_bytes);
}

}  // namespace ghosttile::cover
