#include "silvasim/population/corners.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "silvasim/base/error.h"
#include "silvasim/base/parallel.h"
#include "silvasim/population/corner_overlaps.h"
#include "silvasim/population/independent_set.h"

namespace silvasim::population {

namespace {

// What one vertex adds to the report; whole numbers, so that the order of the sum does not matter.
struct Sums {
  std::uint64_t conflicts = 0, components = 0, largest = 0, fallbacks = 0, removed = 0;
  Weight weight = 0, kept_weight = 0;

  void add(const Sums& other) {
    conflicts += other.conflicts;
    components += other.components;
    largest = std::max(largest, other.largest);
    fallbacks += other.fallbacks;
    removed += other.removed;
    weight += other.weight;
    kept_weight += other.kept_weight;
  }
};

struct Problem {
  const tiles::TileSet& set;
  const tiles::Tiling& tiling;
  std::span<const std::uint64_t> offsets;
  std::span<ecosystem::PlantId> plants;
  std::span<const float> probability;
  config::CornerSolver solver;
};

Weight weight_of(float probability, float radius_m, double most_radius_m) {
  const double weight = static_cast<double>(probability) * static_cast<double>(radius_m) / most_radius_m;
  if (!(weight > 0)) return 0;
  return static_cast<Weight>(std::min(weight, 1.0) * static_cast<double>(weight_one));
}

// Solves one connected group of plants after another, each in the order of their sites.
class Vertex {
 public:
  Vertex(const Problem& problem, const CornerOverlaps& overlaps) : problem_(problem), overlaps_(overlaps) {}

  // The vertex at the south-eastern corner of tile (column - 1, row - 1). Outside the tiling there are no tiles.
  void solve(int column, int row) {
    find_conflicts(column, row);
    if (conflicts_.empty()) return;
    sums_.conflicts += conflicts_.size();
    name_nodes();
    for (std::size_t first = 0; first < nodes_.size(); ++first) {
      if (group_[first] == first) solve_group(first);
    }
  }

  const Sums& sums() const { return sums_; }

 private:
  struct Node {
    std::uint64_t plant;  // index into the plants, in which the nodes are ordered
    Weight weight;
  };

  void find_conflicts(int column, int row) {
    conflicts_.clear();
    radius_.clear();
    std::array<bool, quarter_count> there{};
    std::array<std::size_t, quarter_count> tile{}, position{};
    for (std::size_t q = 0; q < quarter_count; ++q) {
      const int c = column - 1 + static_cast<int>(q % 2), r = row - 1 + static_cast<int>(q / 2);
      there[q] = c >= 0 && r >= 0 && c < problem_.tiling.columns && r < problem_.tiling.rows;
      if (!there[q]) continue;
      position[q] =
          static_cast<std::size_t>(r) * static_cast<std::size_t>(problem_.tiling.columns) + static_cast<std::size_t>(c);
      tile[q] = problem_.tiling.tiles[position[q]];
    }
    for (std::size_t a = 0; a < quarter_count; ++a) {
      for (std::size_t b = a; b < quarter_count && there[a]; ++b) {
        if (!there[b]) continue;
        for (const SitePair& pair : overlaps_.between({a, tile[a]}, {b, tile[b]}, scratch_)) {
          const std::uint64_t i = problem_.offsets[position[a]] + pair.a, j = problem_.offsets[position[b]] + pair.b;
          if (problem_.plants[i] == ecosystem::no_plant || problem_.plants[j] == ecosystem::no_plant) continue;
          conflicts_.push_back({i, j});
          radius_.push_back({i, problem_.set.tiles[tile[a]].sites[pair.a].radius_m});
          radius_.push_back({j, problem_.set.tiles[tile[b]].sites[pair.b].radius_m});
        }
      }
    }
  }

  // Numbers the plants in conflict by their sites and joins those that are connected under their lowest number.
  void name_nodes() {
    std::sort(radius_.begin(), radius_.end());
    radius_.erase(std::unique(radius_.begin(), radius_.end()), radius_.end());
    nodes_.clear();
    for (const auto& [plant, radius_m] : radius_) {
      nodes_.push_back({plant, weight_of(problem_.probability[plant], radius_m, problem_.set.most_radius_m)});
    }
    group_.resize(nodes_.size());
    std::iota(group_.begin(), group_.end(), std::size_t{0});
    for (auto& [a, b] : conflicts_) {
      a = number_of(a);
      b = number_of(b);
      const std::size_t one = root(a), other = root(b);
      group_[std::max(one, other)] = std::min(one, other);
    }
    for (std::size_t node = 0; node < nodes_.size(); ++node) group_[node] = root(node);
  }

  std::size_t number_of(std::uint64_t plant) const {
    const auto at = std::lower_bound(nodes_.begin(), nodes_.end(), plant,
                                     [](const Node& node, std::uint64_t value) { return node.plant < value; });
    return static_cast<std::size_t>(at - nodes_.begin());
  }

  std::size_t root(std::size_t node) const {
    while (group_[node] != node) node = group_[node];
    return node;
  }

  void solve_group(std::size_t first) {
    members_.clear();
    weights_.clear();
    number_in_group_.resize(nodes_.size());
    for (std::size_t node = first; node < nodes_.size(); ++node) {
      if (group_[node] != first) continue;
      number_in_group_[node] = members_.size();
      members_.push_back(node);
      weights_.push_back(nodes_[node].weight);
    }
    Graph graph(members_.size());
    for (const auto& [a, b] : conflicts_) {
      if (group_[a] == first) graph.add_edge(number_in_group_[a], number_in_group_[b]);
    }

    const NodeSet kept = choose(graph);

    ++sums_.components;
    sums_.largest = std::max<std::uint64_t>(sums_.largest, members_.size());
    for (std::size_t i = 0; i < members_.size(); ++i) {
      sums_.weight += weights_[i];
      if (kept[i / 64] >> (i % 64) & 1) {
        sums_.kept_weight += weights_[i];
      } else {
        ++sums_.removed;
        problem_.plants[nodes_[members_[i]].plant] = ecosystem::no_plant;
      }
    }
  }

  NodeSet choose(const Graph& graph) {
    if (problem_.solver == config::CornerSolver::paper) return paper_set(graph, weights_);
    if (graph.nodes() <= most_exact_nodes) {
      if (auto best = optimal_set(graph, weights_)) return *std::move(best);
    }
    ++sums_.fallbacks;
    return greedy_set(graph, weights_);
  }

  const Problem& problem_;
  const CornerOverlaps& overlaps_;
  Sums sums_;

  // Kept between vertices only to spare allocations.
  std::vector<SitePair> scratch_;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> conflicts_;  // plants, then node numbers
  std::vector<std::pair<std::uint64_t, float>> radius_;             // of each plant in conflict
  std::vector<Node> nodes_;
  std::vector<std::size_t> group_, members_, number_in_group_;
  std::vector<Weight> weights_;
};

}  // namespace

CornerReport prune_corners(const tiles::TileSet& set, const tiles::Tiling& tiling,
                           std::span<const std::uint64_t> offsets, std::span<ecosystem::PlantId> plants,
                           std::span<const float> probability, config::CornerSolver solver,
                           const base::Progress& progress) {
  assert(offsets.size() == tiling.tiles.size() + 1);
  assert(plants.size() == offsets.back() && probability.size() == plants.size());
  if (!(set.side_m > 8 * set.most_radius_m)) {
    throw base::Error("tiles of " + std::to_string(set.side_m) + " m are too small for sites of up to " +
                      std::to_string(set.most_radius_m) + " m: the side must be larger than 8 times that radius");
  }
  const Problem problem{set, tiling, offsets, plants, probability, solver};
  const CornerOverlaps overlaps(set, tiling);

  // Vertices share no site, so rows of them may be solved in any order; between batches the user may stop.
  const std::size_t rows = static_cast<std::size_t>(tiling.rows) + 1;
  constexpr std::size_t batch = 64;
  std::vector<Sums> sums(rows);
  for (std::size_t first = 0; first < rows; first += batch) {
    base::report(progress, "corners", static_cast<double>(first) / static_cast<double>(rows));
    base::parallel_for(std::min(batch, rows - first), [&](std::size_t i) {
      Vertex vertex(problem, overlaps);
      for (int column = 0; column <= tiling.columns; ++column) vertex.solve(column, static_cast<int>(first + i));
      sums[first + i] = vertex.sums();
    });
  }
  base::report(progress, "corners", 1);

  Sums total;
  for (const Sums& row : sums) total.add(row);
  CornerReport report;
  report.conflicts = total.conflicts;
  report.components = total.components;
  report.largest = total.largest;
  report.fallbacks = total.fallbacks;
  report.removed = total.removed;
  report.weight = static_cast<double>(total.weight) / static_cast<double>(weight_one);
  report.kept_weight = static_cast<double>(total.kept_weight) / static_cast<double>(weight_one);
  return report;
}

}  // namespace silvasim::population
