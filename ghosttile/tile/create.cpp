#include "ghosttile/tile/create.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "ghosttile/tile/hilbert.h"
#include "ghosttile/tile/sphere_columns.h"
#include "silvasim/base/error.h"
#include "silvasim/base/parallel.h"

namespace ghosttile::tile {

namespace {

using silvasim::base::Error;

std::vector<Candidate> spread_candidates(const CreateOptions& options) {
  std::vector<Candidate> candidates;
  for (std::size_t o = 0; o < options.spreads.size(); ++o) {
    for (std::uint32_t c = 0; c < options.spreads[o].count; ++c)
      candidates.push_back(
          random_frame(options.seed, static_cast<std::uint16_t>(o), c, options.spreads[o], options.side_m));
  }
  std::vector<std::uint32_t> places;
  for (const Candidate& candidate : candidates) places.push_back(hilbert_place(candidate.at / options.side_m));
  std::vector<std::uint32_t> order(candidates.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, {}, [&](std::uint32_t c) { return places[c]; });
  std::vector<Candidate> sorted;
  for (const std::uint32_t c : order) sorted.push_back(candidates[c]);
  return sorted;
}

// The farthest tile of which a candidate can touch one of this tile.
int offsets_reach(const GhostTile& tile) {
  float most = 0;
  for (const Candidate& candidate : tile.candidates)
    most = std::max(most, candidate.scale * objects::reach_of(tile.objects[candidate.object].spheres));
  const float between = 2 * most + tile.delta_m;
  const bool too_far = !(between / tile.side_m < static_cast<float>(most_reach));
  if (too_far)
    throw Error("the tile of " + std::to_string(tile.side_m) + " m is too small for its objects: they reach " +
                std::to_string(most) + " m from their origins; a side of " +
                std::to_string(between / static_cast<float>(most_reach)) +
                " m would be enough, twice the reach is usual");
  return std::max(1, static_cast<int>(std::floor(std::max(0.0f, between) / tile.side_m)) + 1);
}

// Candidates by the cell of a grid that their bounding spheres' centres lie in, the tile repeated in all directions.
struct Grid {
  int cells = 1;  // along a side
  float cell_m = 1;
  std::vector<std::uint32_t> first, members;

  Grid(const SphereColumns& columns, float side_m, float widest_m) {
    const std::size_t count = columns.candidate_bounds.size();
    const int wanted = static_cast<int>(std::cbrt(static_cast<double>(count) / 4)) + 1;
    const int useful = static_cast<int>(side_m / std::max(widest_m * 0.5f, side_m / 64)) + 1;
    cells = std::clamp(std::min(wanted, useful), 1, 64);
    cell_m = side_m / static_cast<float>(cells);
    std::vector<std::uint32_t> cell_of(count);
    first.assign(static_cast<std::size_t>(cells * cells * cells) + 1, 0);
    for (std::size_t c = 0; c < count; ++c) {
      cell_of[c] = static_cast<std::uint32_t>(index(columns.candidate_bounds[c].centre));
      ++first[cell_of[c] + 1];
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    members.resize(count);
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::uint32_t c = 0; c < count; ++c) members[next[cell_of[c]]++] = c;
  }
  int along(float at) const { return static_cast<int>(std::floor(at / cell_m)); }
  int wrapped(int cell) const { return ((cell % cells) + cells) % cells; }
  int index(const V3& at) const {
    return (wrapped(along(at.z)) * cells + wrapped(along(at.y))) * cells + wrapped(along(at.x));
  }
};

struct Arc {
  std::uint32_t from, to;
  Offset v;
};

// All arcs from candidate i to candidates j >= i: of j == i only those to one side, since each stands for two.
template <typename Found>
std::uint64_t find_arcs(const SphereColumns& columns, const Grid& grid, const GhostTile& tile, int reach,
                        float widest_m, std::uint32_t i, const Found& found) {
  const auto& bound = columns.candidate_bounds[i];
  const float around = bound.radius + widest_m + tile.delta_m + 1e-5f;
  if (around < 0) return 0;
  std::uint64_t looked_at = 0;
  const float slack = grid.cell_m * 1e-3f;
  std::array<int, 3> low{}, high{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float at = bound.centre[static_cast<int>(axis)];
    low[axis] = grid.along(at - around - slack);
    high[axis] = grid.along(at + around + slack);
  }
  // A cell of the repeated grid holds a candidate j at its own centre moved by whole tiles; which tile j's origin
  // belongs to follows from how far its centre was wrapped.
  for (int z = low[2]; z <= high[2]; ++z) {
    for (int y = low[1]; y <= high[1]; ++y) {
      for (int x = low[0]; x <= high[0]; ++x) {
        const auto cell =
            static_cast<std::size_t>((grid.wrapped(z) * grid.cells + grid.wrapped(y)) * grid.cells + grid.wrapped(x));
        for (std::uint32_t m = grid.first[cell]; m < grid.first[cell + 1]; ++m) {
          const std::uint32_t j = grid.members[m];
          if (j < i) continue;
          const V3& centre = columns.candidate_bounds[j].centre;
          const Offset v{(x - grid.along(centre.x)) / grid.cells, (y - grid.along(centre.y)) / grid.cells,
                         (z - grid.along(centre.z)) / grid.cells};
          if (j == i && (v[2] < 0 || (v[2] == 0 && (v[1] < 0 || (v[1] == 0 && v[0] <= 0))))) continue;
          if (std::abs(v[0]) > reach || std::abs(v[1]) > reach || std::abs(v[2]) > reach) continue;
          ++looked_at;
          const V3 shift(static_cast<float>(v[0]) * tile.side_m, static_cast<float>(v[1]) * tile.side_m,
                         static_cast<float>(v[2]) * tile.side_m);
          if (columns.collide(i, j, shift, tile.delta_m)) found(Arc{i, j, v});
        }
      }
    }
  }
  return looked_at;
}

CollisionGraph graph_from(const std::vector<std::vector<Arc>>& found, std::uint32_t candidates, int reach) {
  CollisionGraph graph;
  graph.candidates = candidates;
  graph.reach = reach;
  const auto bit_of = [&](const Arc& arc) {
    return static_cast<std::uint64_t>(graph.offset_index(arc.v)) * graph.words_a_tile() * 64 + arc.to;
  };
  // Both directions of every arc, by the candidate they start from.
  std::vector<std::uint64_t> first(candidates + 1, 0);
  const auto each = [&](const auto& visit) {
    for (const auto& arcs : found) {
      for (const Arc& arc : arcs) {
        visit(arc);
        visit(Arc{arc.to, arc.from, {-arc.v[0], -arc.v[1], -arc.v[2]}});
      }
    }
  };
  each([&](const Arc& arc) { ++first[arc.from + 1]; });
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::uint32_t> bits(first.back());
  std::vector<std::uint64_t> next(first.begin(), first.end() - 1);
  each([&](const Arc& arc) { bits[next[arc.from]++] = static_cast<std::uint32_t>(bit_of(arc)); });

  graph.first_word.push_back(0);
  for (std::uint32_t i = 0; i < candidates; ++i) {
    std::sort(bits.begin() + static_cast<std::ptrdiff_t>(first[i]),
              bits.begin() + static_cast<std::ptrdiff_t>(first[i + 1]));
    for (std::uint64_t b = first[i]; b < first[i + 1]; ++b) {
      const auto place = static_cast<std::uint16_t>(bits[b] / 64);
      if (graph.first_word.back() == graph.places.size() || graph.places.back() != place) {
        graph.places.push_back(place);
        graph.bits.push_back(0);
      }
      graph.bits.back() |= std::uint64_t{1} << bits[b] % 64;
    }
    graph.first_word.push_back(static_cast<std::uint32_t>(graph.places.size()));
  }
  graph.places.shrink_to_fit();
  graph.bits.shrink_to_fit();
  return graph;
}

}  // namespace

GhostTile create(std::vector<objects::Detail> objects, const CreateOptions& options,
                 const silvasim::base::Progress& progress, CreateCounts* counts) {
  GhostTile tile;
  tile.side_m = options.side_m;
  tile.delta_m = options.delta_m;
  tile.seed = options.seed;
  tile.objects = std::move(objects);
  std::uint64_t wanted = 0;
  for (const Spread& spread : options.spreads) wanted += spread.count;
  if (wanted > 65535) throw Error("the tile has " + std::to_string(wanted) + " candidates in all; 65535 are the most");
  tile.candidates = spread_candidates(options);
  if (tile.candidates.empty()) throw Error("the tile has no candidates: give its objects a count above 0");
  const int reach = offsets_reach(tile);
  const auto count = static_cast<std::uint32_t>(tile.candidates.size());
  const auto places = static_cast<std::uint64_t>((count + 63) / 64) *
                      static_cast<std::uint64_t>((2 * reach + 1) * (2 * reach + 1) * (2 * reach + 1));
  if (places > 65536)
    throw Error(std::to_string(count) + " candidates are too many for a tile whose objects reach " +
                std::to_string(reach) + " tiles far: take fewer, or a larger tile");

  const SphereColumns columns = sphere_columns(tile.objects, tile.candidates);
  float widest = 0;
  for (const auto& bound : columns.candidate_bounds) widest = std::max(widest, bound.radius);
  const Grid grid(columns, tile.side_m, widest);

  constexpr std::uint32_t chunk = 16;
  std::vector<std::vector<Arc>> found((count + chunk - 1) / chunk);
  std::vector<std::uint64_t> looked_at(found.size(), 0);
  silvasim::base::parallel_for(found.size(), [&](std::size_t c) {
    const auto first = static_cast<std::uint32_t>(c) * chunk;
    for (std::uint32_t i = first; i < std::min(count, first + chunk); ++i)
      looked_at[c] +=
          find_arcs(columns, grid, tile, reach, widest, i, [&](const Arc& arc) { found[c].push_back(arc); });
    silvasim::base::report(progress, "collisions", static_cast<double>(c) / static_cast<double>(found.size()));
  });
  tile.graph = graph_from(found, count, reach);
  if (counts) {
    counts->looked_at = std::accumulate(looked_at.begin(), looked_at.end(), std::uint64_t{0});
    counts->colliding = tile.graph.arcs() / 2;
  }
  return tile;
}

float reach_of(const GhostTile& tile) {
  float most = 0;
  for (const Candidate& candidate : tile.candidates) {
    const objects::Detail& object = tile.objects[candidate.object];
    float farthest = objects::reach_of(object.spheres);
    for (const V3& anchor : object.anchors) farthest = std::max(farthest, anchor.length());
    most = std::max(most, candidate.scale * farthest);
  }
  return most;
}

}  // namespace ghosttile::tile
