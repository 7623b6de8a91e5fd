#include "ghosttile/fill/survivors.h"

#include <algorithm>
#include <bit>
#include <string>

#include "ghosttile/fill/cull.h"
#include "ghosttile/fill/place_hash.h"
#include "silvasim/base/error.h"
#include "silvasim/base/math.h"
#include "silvasim/base/parallel.h"

namespace ghosttile::fill {

namespace {

constexpr int chunk_tiles = 64;        // a piece of work: so many columns along each side
constexpr int levels_a_tile = 8;       // of elevation
constexpr int levels_of_density = 16;  // of distance to the boundary
constexpr int stages_a_level = 24;     // one to a doubling: about one instance a tile
constexpr int most_stages = 65535;

// A tile's survivors before they have a slot.
struct Culled {
  TilePlace place;
  std::size_t first_run = 0, runs = 0, first = 0, count = 0;  // in the chunk's columns
};
struct Chunk {
  std::vector<Culled> tiles;
  std::vector<std::pair<std::int32_t, std::uint32_t>> runs;  // stage, count
  std::vector<std::uint16_t> order;
  std::vector<Block> blocks;
  std::uint64_t looked_at = 0;
};

struct Fields {
  std::vector<density::Field> density, least_scale, most_scale;  // by object; empty: none asked for
};

class Culling {
 public:
  Culling(const Plan& plan, const TileBox& box)
      : plan_(plan),
        tile_(*plan.tile),
        box_(box),
        columns_(object_columns(tile_)),
        reach_(static_cast<double>(tile::reach_of(tile_)) + density::gradient_step_m) {}

  Chunk chunk(const TileBox& box) const {
    Chunk chunk;
    Fields fields;
    for (const ObjectRule& rule : plan_.objects) {
      fields.density.push_back(rule.density);
      fields.least_scale.push_back(rule.least_scale.value_or(density::Field()));
      fields.most_scale.push_back(rule.most_scale.value_or(density::Field()));
    }
    Work work;
    work.least.resize(tile_.candidates.size());
    work.most.resize(tile_.candidates.size());
    work.other.resize(tile_.candidates.size());
    halve(box, fields, work, chunk);
    std::sort(chunk.tiles.begin(), chunk.tiles.end(),
              [](const Culled& a, const Culled& b) { return a.place < b.place; });
    return chunk;
  }

 private:
  struct Work {
    CullScratch scratch;
    std::vector<float> least, most, other, ground;
    std::vector<std::pair<std::int32_t, std::uint16_t>> keyed;  // stage, candidate
  };

  density::Box3 space_of(const TileBox& box) const {
    const auto side = static_cast<double>(tile_.side_m);
    return {{box.x0 * side - reach_, box.y0 * side - reach_, box.z0 * side - reach_},
            {box.x1 * side + reach_, box.y1 * side + reach_, box.z1 * side + reach_}};
  }

  // Cuts the fields down to the box, and the box into halves along the longest side until it is one block. Always whole blocks, also
  // where only a part of one is filled: what is compiled depends on the place alone.
  void halve(const TileBox& box, const Fields& fields, Work& work, Chunk& chunk) const {
    if (intersection(box, box_).empty()) return;
    const density::Box3 space = space_of(box);
    Fields inside;
    bool any = false;
    for (std::size_t o = 0; o < fields.density.size(); ++o) {
      const bool some = fields.density[o].range(space).most > 0;
      any = any || some;
      inside.density.push_back(some ? fields.density[o].within(space) : density::Field());
      inside.least_scale.push_back(plan_.objects[o].least_scale ? fields.least_scale[o].within(space)
                                                                : density::Field());
      inside.most_scale.push_back(plan_.objects[o].most_scale ? fields.most_scale[o].within(space) : density::Field());
    }
    if (!any) return;
    const int wide = (box.x1 - box.x0) / block_tiles, deep = (box.y1 - box.y0) / block_tiles, high = box.z1 - box.z0;
    if (wide == 1 && deep == 1 && high == 1) {
      block(box, inside, work, chunk);
      return;
    }
    TileBox first = box, second = box;
    if (high >= wide && high >= deep) {
      first.z1 = second.z0 = box.z0 + high / 2;
    } else if (wide >= deep) {
      first.x1 = second.x0 = box.x0 + wide / 2 * block_tiles;
    } else {
      first.y1 = second.y0 = box.y0 + deep / 2 * block_tiles;
    }
    halve(first, inside, work, chunk);
    halve(second, inside, work, chunk);
  }

  void block(const TileBox& whole, const Fields& fields, Work& work, Chunk& chunk) const {
    Block block{whole.x0, whole.y0, whole.z0, {}};
    const auto side = static_cast<double>(tile_.side_m);
    const V3d corner(block.x * side, block.y * side, block.z * side);
    const density::Box3 space = space_of(whole);
    std::vector<density::Compiled> density, least_scale, most_scale;
    float sure = 0;
    for (std::size_t o = 0; o < fields.density.size(); ++o) {
      density.push_back(fields.density[o].compiled(corner, space));
      sure += density.back().range.least;
      least_scale.push_back(plan_.objects[o].least_scale ? fields.least_scale[o].compiled(corner, space)
                                                         : density::Compiled());
      most_scale.push_back(plan_.objects[o].most_scale ? fields.most_scale[o].compiled(corner, space)
                                                       : density::Compiled());
    }
    bool any = false;
    const TileBox box = intersection(whole, box_);
    for (int y = box.y0; y < box.y1; ++y) {
      for (int x = box.x0; x < box.x1; ++x) {
        const V3 offset(static_cast<float>(x - block.x) * tile_.side_m, static_cast<float>(y - block.y) * tile_.side_m,
                        0);
        chunk.looked_at += tile_.candidates.size();
        work.keyed.clear();
        for (std::size_t o = 0; o < columns_.size(); ++o) {
          if (!density[o].empty())
            object(o, density[o], least_scale[o], most_scale[o], corner, offset, {x, y, box.z0}, work);
        }
        if (work.keyed.empty()) continue;
        any = true;
        keep({x, y, box.z0}, work, chunk);
      }
    }
    if (any && sure < 1) {
      block.density = std::move(density);
      chunk.blocks.push_back(std::move(block));
    }
  }

  // Appends the object's survivors in the tile with their stages.
  void object(std::size_t o, const density::Compiled& density, const density::Compiled& least_scale,
              const density::Compiled& most_scale, const V3d& corner, const V3& offset, const TilePlace& place,
              Work& work) const {
    const ObjectColumns& columns = columns_[o];
    const ObjectRule& rule = plan_.objects[o];
    const std::size_t count = columns.candidates.size();
    densities_at(columns, density, offset, work.scratch, work.least.data(), work.most.data());
    if (rule.direction) {
      cosines_at(columns, *rule.direction, density, corner, offset, work.scratch, work.other.data());
      for (std::size_t c = 0; c < count; ++c) {
        if (!(work.other[c] >= rule.direction->least_cosine && work.other[c] <= rule.direction->most_cosine))
          work.least[c] = 0;
      }
    }
    if (rule.least_scale) {
      values_at_origins(columns, least_scale, offset, work.scratch, work.other.data());
      for (std::size_t c = 0; c < count; ++c)
        if (columns.scale[c] < work.other[c]) work.least[c] = 0;
    }
    if (rule.most_scale) {
      values_at_origins(columns, most_scale, offset, work.scratch, work.other.data());
      for (std::size_t c = 0; c < count; ++c)
        if (columns.scale[c] > work.other[c]) work.least[c] = 0;
    }
    if (plan_.priority == Priority::elevation) heights(columns, corner, offset, work);
    const std::uint64_t chance = tile_hash(plan_.seed, place);
    const auto all = static_cast<float>(tile_.candidates.size());
    for (std::size_t c = 0; c < count; ++c) {
      if (!(work.least[c] > 0)) continue;
      const std::uint16_t candidate = columns.candidates[c];
      // A draw of the exponential distribution with the density as rate, times the number of candidates: about
      // how many of the tile come before.
      const float u = (static_cast<float>(candidate_hash(chance, candidate) >> 40) + 0.5f) * 0x1p-24f;
      const float rank = -silvasim::base::log(1 - u) / work.most[c] * all;
      work.keyed.emplace_back(stage(rank, work.most[c], work.other[c]), candidate);
    }
  }

  // Four stages to a doubling of `rank` where chance alone decides; within a level, one to a doubling.
  std::int32_t stage(float rank, float density, float height_m) const {
    const auto quarters = static_cast<std::int32_t>(std::bit_cast<std::uint32_t>(1 + rank) >> 21) - (127 << 2);
    if (plan_.priority == Priority::random) return std::min(quarters, 127);
    const std::int32_t level =
        plan_.priority == Priority::elevation
            ? static_cast<std::int32_t>(std::floor(height_m * (static_cast<float>(levels_a_tile) / tile_.side_m)))
            : static_cast<std::int32_t>(std::min(density, 0.999f) * levels_of_density);
    return level * stages_a_level + std::min(quarters / 4, stages_a_level - 1);
  }

  // Heights of the candidates' origins above the ground, or above the scene's zero, into `other`.
  void heights(const ObjectColumns& columns, const V3d& corner, const V3& offset, Work& work) const {
    const std::size_t count = columns.candidates.size();
    for (std::size_t c = 0; c < count; ++c) work.other[c] = static_cast<float>(corner.z) + columns.at_z[c];
    if (!plan_.ground) return;
    work.ground.resize(count);
    work.scratch.x.resize(density::block_size);
    work.scratch.y.resize(density::block_size);
    for (std::size_t first = 0; first < count; first += density::block_size) {
      const std::size_t n = std::min(density::block_size, count - first);
      for (std::size_t c = 0; c < n; ++c) {
        work.scratch.x[c] = columns.at_x[first + c] + offset.x;
        work.scratch.y[c] = columns.at_y[first + c] + offset.y;
      }
      plan_.ground->sample(corner, work.scratch.x.data(), work.scratch.y.data(), n, work.ground.data() + first);
    }
    for (std::size_t c = 0; c < count; ++c) work.other[c] -= work.ground[c];
  }

  static void keep(const TilePlace& place, Work& work, Chunk& chunk) {
    std::ranges::sort(work.keyed);
    Culled culled{place, chunk.runs.size(), 0, chunk.order.size(), work.keyed.size()};
    for (std::size_t k = 0; k < work.keyed.size(); ++k) {
      if (k == 0 || work.keyed[k].first != work.keyed[k - 1].first) chunk.runs.emplace_back(work.keyed[k].first, 0u);
      ++chunk.runs.back().second;
      chunk.order.push_back(work.keyed[k].second);
    }
    culled.runs = chunk.runs.size() - culled.first_run;
    chunk.tiles.push_back(culled);
  }

  const Plan& plan_;
  const tile::GhostTile& tile_;
  TileBox box_;
  std::vector<ObjectColumns> columns_;
  double reach_;
};

std::vector<TileBox> chunks_of(const TileBox& box) {
  std::vector<TileBox> chunks;
  const auto floor_to = [](int tile) {
    return tile >= 0 ? tile / chunk_tiles * chunk_tiles : -((chunk_tiles - 1 - tile) / chunk_tiles) * chunk_tiles;
  };
  for (int y = floor_to(box.y0); y < box.y1; y += chunk_tiles)
    for (int x = floor_to(box.x0); x < box.x1; x += chunk_tiles)
      chunks.push_back({x, y, box.z0, x + chunk_tiles, y + chunk_tiles, box.z1});
  return chunks;
}

Survivors joined(std::vector<Chunk> chunks, std::uint32_t candidates) {
  Survivors survivors;
  survivors.words = (candidates + 63) / 64;
  std::vector<TilePlace> places;
  std::int32_t least = 0, most = 0;
  bool first_run = true;
  for (const Chunk& chunk : chunks) {
    for (const Culled& tile : chunk.tiles) places.push_back(tile.place);
    for (const auto& [stage, count] : chunk.runs) {
      least = first_run ? stage : std::min(least, stage);
      most = first_run ? stage : std::max(most, stage);
      first_run = false;
    }
  }
  if (most - least >= most_stages)
    throw silvasim::base::Error("details by elevation reach over too many levels: give them a ground to measure from");
  std::sort(places.begin(), places.end());
  survivors.index = TileIndex(places);
  survivors.first_stage = least;
  survivors.stages = static_cast<std::uint32_t>(most - least + 1);
  const std::uint32_t slots = survivors.index.size();
  survivors.alive.assign(std::size_t{slots} * survivors.words, 0);
  survivors.first_run.assign(slots + 1, 0);
  survivors.first.assign(slots + 1, 0);
  for (const Chunk& chunk : chunks) {
    for (const Culled& tile : chunk.tiles) {
      const std::uint32_t slot = survivors.index.slot(tile.place.x, tile.place.y, tile.place.z);
      survivors.first_run[slot + 1] = static_cast<std::uint32_t>(tile.runs);
      survivors.first[slot + 1] = static_cast<std::uint32_t>(tile.count);
    }
  }
  std::uint64_t all = 0;
  for (const std::uint32_t count : survivors.first) all += count;
  if (all > 0xFFFFFFFFu)
    throw silvasim::base::Error("more than four thousand million candidates are possible at once: fill a smaller box");
  for (std::uint32_t s = 0; s < slots; ++s) {
    survivors.first_run[s + 1] += survivors.first_run[s];
    survivors.first[s + 1] += survivors.first[s];
  }
  survivors.runs.resize(survivors.first_run.back());
  survivors.order.resize(survivors.first.back());
  silvasim::base::parallel_for(chunks.size(), [&](std::size_t c) {
    Chunk& chunk = chunks[c];
    for (const Culled& tile : chunk.tiles) {
      const std::uint32_t slot = survivors.index.slot(tile.place.x, tile.place.y, tile.place.z);
      for (std::size_t r = 0; r < tile.runs; ++r) {
        const auto [stage, count] = chunk.runs[tile.first_run + r];
        survivors.runs[survivors.first_run[slot] + r] = {static_cast<std::uint16_t>(stage - least),
                                                         static_cast<std::uint16_t>(count)};
      }
      std::uint64_t* alive = survivors.alive.data() + std::size_t{slot} * survivors.words;
      for (std::size_t k = 0; k < tile.count; ++k) {
        const std::uint16_t candidate = chunk.order[tile.first + k];
        survivors.order[survivors.first[slot] + k] = candidate;
        alive[candidate / 64] |= std::uint64_t{1} << candidate % 64;
      }
    }
    chunk.tiles = {};
    chunk.runs = {};
    chunk.order = {};
  });
  for (Chunk& chunk : chunks) std::ranges::move(chunk.blocks, std::back_inserter(survivors.blocks));
  for (const Chunk& chunk : chunks) survivors.looked_at += chunk.looked_at;
  return survivors;
}

}  // namespace

Survivors survivors_of(const Plan& plan, const TileBox& box, const silvasim::base::Progress& progress) {
  const Culling culling(plan, box);
  const std::vector<TileBox> boxes = chunks_of(box);
  std::vector<Chunk> chunks(boxes.size());
  silvasim::base::parallel_for(boxes.size(), [&](std::size_t c) {
    chunks[c] = culling.chunk(boxes[c]);
    silvasim::base::report(progress, "cull", static_cast<double>(c) / static_cast<double>(boxes.size()));
  });
  return joined(std::move(chunks), static_cast<std::uint32_t>(plan.tile->candidates.size()));
}

}  // namespace ghosttile::fill
