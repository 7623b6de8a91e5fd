#include "ghosttile/fill/refuse.h"

#include <algorithm>
#include <bit>

#include "ghosttile/fill/place_hash.h"
#include "silvasim/base/parallel.h"

namespace ghosttile::fill {

namespace {

struct Scratch {
  density::Scratch fields;
  std::vector<std::uint16_t> candidates;
  std::vector<std::uint32_t> first;  // of each one's anchors, and the end
  std::vector<float> x, y, z, value, sum;
};

// The sum of all objects' densities, the mean over each candidate's anchors.
void sum_densities(const tile::GhostTile& tile, const Block& block, const V3& offset, Scratch& scratch) {
  scratch.x.clear();
  scratch.y.clear();
  scratch.z.clear();
  scratch.first.assign(1, 0);
  for (const std::uint16_t c : scratch.candidates) {
    const tile::Candidate& candidate = tile.candidates[c];
    for (const V3& anchor : tile.objects[candidate.object].anchors) {
      const V3 at = candidate(anchor) + offset;
      scratch.x.push_back(at.x);
      scratch.y.push_back(at.y);
      scratch.z.push_back(at.z);
    }
    scratch.first.push_back(static_cast<std::uint32_t>(scratch.x.size()));
  }
  scratch.sum.assign(scratch.x.size(), 0);
  scratch.value.resize(density::block_size);
  for (const density::Compiled& density : block.density) {
    if (density.empty()) continue;
    for (std::size_t first = 0; first < scratch.x.size(); first += density::block_size) {
      const std::size_t count = std::min(density::block_size, scratch.x.size() - first);
      density.evaluate({scratch.x.data() + first, scratch.y.data() + first, scratch.z.data() + first, count},
                       scratch.fields, scratch.value.data());
      for (std::size_t p = 0; p < count; ++p) scratch.sum[first + p] += scratch.value[p];
    }
  }
  for (std::size_t c = 0; c < scratch.candidates.size(); ++c) {
    float mean = 0;
    for (std::uint32_t a = scratch.first[c]; a < scratch.first[c + 1]; ++a) mean += scratch.sum[a];
    scratch.sum[c] = mean / static_cast<float>(scratch.first[c + 1] - scratch.first[c]);
  }
}

}  // namespace

void refuse(const Plan& plan, const Survivors& survivors, std::vector<std::uint64_t>& chosen,
            std::vector<std::uint64_t>& refused) {
  const tile::GhostTile& tile = *plan.tile;
  constexpr std::size_t batch = 64;
  silvasim::base::parallel_for((survivors.blocks.size() + batch - 1) / batch, [&](std::size_t b) {
    Scratch scratch;
    for (std::size_t k = b * batch; k < std::min(survivors.blocks.size(), (b + 1) * batch); ++k) {
      const Block& block = survivors.blocks[k];
      for (int y = block.y; y < block.y + block_tiles; ++y) {
        for (int x = block.x; x < block.x + block_tiles; ++x) {
          const std::uint32_t slot = survivors.index.slot(x, y, block.z);
          if (slot == no_slot) continue;
          const std::size_t base = std::size_t{slot} * survivors.words;
          scratch.candidates.clear();
          for (std::uint32_t w = 0; w < survivors.words; ++w)
            for (std::uint64_t left = chosen[base + w]; left != 0; left &= left - 1)
              scratch.candidates.push_back(
                  static_cast<std::uint16_t>(w * 64 + static_cast<std::uint32_t>(std::countr_zero(left))));
          if (scratch.candidates.empty()) continue;
          sum_densities(
              tile, block,
              V3(static_cast<float>(x - block.x) * tile.side_m, static_cast<float>(y - block.y) * tile.side_m, 0),
              scratch);
          const std::uint64_t chance = tile_hash(plan.seed, {x, y, block.z});
          for (std::size_t c = 0; c < scratch.candidates.size(); ++c) {
            const std::uint16_t candidate = scratch.candidates[c];
            const float u = static_cast<float>(candidate_hash(chance, candidate) & 0xFFFFFF) * 0x1p-24f;
            if (u < scratch.sum[c]) continue;
            const std::uint64_t bit = std::uint64_t{1} << candidate % 64;
            chosen[base + candidate / 64] &= ~bit;
            refused[base + candidate / 64] |= bit;
          }
        }
      }
    }
  });
}

}  // namespace ghosttile::fill
