#include "silvasim/population/independent_set.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace silvasim::population {

namespace {

bool holds(const NodeSet& set, std::size_t node) { return set[node / 64] >> (node % 64) & 1; }
void insert(NodeSet& set, std::size_t node) { set[node / 64] |= std::uint64_t{1} << (node % 64); }
void erase(NodeSet& set, std::size_t node) { set[node / 64] &= ~(std::uint64_t{1} << (node % 64)); }

NodeSet all_nodes(const Graph& graph) {
  NodeSet set((graph.nodes() + 63) / 64);
  for (std::size_t node = 0; node < graph.nodes(); ++node) insert(set, node);
  return set;
}

// How many neighbours of the node are in the set.
std::uint64_t degree_in(const Graph& graph, const NodeSet& set, std::size_t node) {
  const auto row = graph.neighbours(node);
  std::uint64_t degree = 0;
  for (std::size_t w = 0; w < set.size(); ++w) degree += static_cast<std::uint64_t>(std::popcount(row[w] & set[w]));
  return degree;
}

Weight weight_of(const NodeSet& set, std::span<const Weight> weights) {
  Weight sum = 0;
  for (std::size_t node = 0; node < weights.size(); ++node) {
    if (holds(set, node)) sum += weights[node];
  }
  return sum;
}

// Depth first, "the lowest node stays" before "it goes": the first set found of a weight is the one that wins its ties.
class BranchAndBound {
 public:
  BranchAndBound(const Graph& graph, std::span<const Weight> weights, Weight at_least, std::uint64_t most_steps)
      : weights_(weights), to_beat_(at_least), steps_left_(most_steps) {
    for (std::size_t node = 0; node < graph.nodes(); ++node) rows_[node] = graph.neighbours(node)[0];
  }

  // `open`: nodes still to be decided. False when the steps are used up.
  bool search(std::uint64_t open, std::uint64_t kept, Weight weight) {
    while (true) {
      if (steps_left_ == 0) return false;
      --steps_left_;
      if (open == 0) {
        if (worth(weight)) {
          to_beat_ = weight;
          best_ = kept;
          found_ = true;
        }
        return true;
      }
      const int node = std::countr_zero(open);
      const std::uint64_t bit = std::uint64_t{1} << node;
      const std::uint64_t rivals = rows_[node] & open;
      // A node that outweighs all its rivals together stays in some best set, and as the lowest open one it wins ties.
      if (weight_of(rivals) > weights_[static_cast<std::size_t>(node)]) {
        if (!worth(weight + bound(open))) return true;
        if (!search(open & ~bit & ~rivals, kept | bit, weight + weights_[static_cast<std::size_t>(node)])) return false;
        open &= ~bit;
        if (!worth(weight + bound(open))) return true;
      } else {
        open &= ~bit & ~rivals;
        kept |= bit;
        weight += weights_[static_cast<std::size_t>(node)];
      }
    }
  }

  std::uint64_t best() const { return best_; }

 private:
  // Until a set is found, one as heavy as the heuristic's will do; afterwards only a heavier one.
  bool worth(Weight reachable) const { return found_ ? reachable > to_beat_ : reachable >= to_beat_; }

  Weight weight_of(std::uint64_t set) const {
    Weight sum = 0;
    for (; set != 0; set &= set - 1) sum += weights_[static_cast<std::size_t>(std::countr_zero(set))];
    return sum;
  }

  // Of the nodes of a clique at most one stays: parts the open nodes into cliques and sums their heaviest nodes.
  Weight bound(std::uint64_t open) const {
    Weight sum = 0;
    while (open != 0) {
      Weight heaviest = 0;
      std::uint64_t candidates = open;
      while (candidates != 0) {
        const int node = std::countr_zero(candidates);
        heaviest = std::max(heaviest, weights_[static_cast<std::size_t>(node)]);
        open &= ~(std::uint64_t{1} << node);
        candidates &= rows_[node];
      }
      sum += heaviest;
    }
    return sum;
  }

  std::uint64_t rows_[most_exact_nodes] = {};
  std::span<const Weight> weights_;
  Weight to_beat_;
  std::uint64_t steps_left_;
  std::uint64_t best_ = 0;
  bool found_ = false;
};

}  // namespace

std::optional<NodeSet> optimal_set(const Graph& graph, std::span<const Weight> weights, std::uint64_t most_steps) {
  assert(graph.nodes() <= most_exact_nodes && weights.size() == graph.nodes());
  if (graph.nodes() == 0) return NodeSet{};
  BranchAndBound solver(graph, weights, weight_of(greedy_set(graph, weights), weights), most_steps);
  if (!solver.search(all_nodes(graph)[0], 0, 0)) return std::nullopt;
  return NodeSet{solver.best()};
}

NodeSet greedy_set(const Graph& graph, std::span<const Weight> weights) {
  NodeSet open = all_nodes(graph), kept(open.size());
  while (true) {
    std::size_t best = graph.nodes();
    std::uint64_t best_degree = 0;
    for (std::size_t node = 0; node < graph.nodes(); ++node) {
      if (!holds(open, node)) continue;
      // Compare the quotients without dividing, so that ties are ties.
      const std::uint64_t degree = degree_in(graph, open, node) + 1;
      if (best == graph.nodes() || weights[node] * best_degree > weights[best] * degree) {
        best = node;
        best_degree = degree;
      }
    }
    if (best == graph.nodes()) return kept;
    insert(kept, best);
    erase(open, best);
    const auto row = graph.neighbours(best);
    for (std::size_t w = 0; w < open.size(); ++w) open[w] &= ~row[w];
  }
}

NodeSet paper_set(const Graph& graph, std::span<const Weight> weights) {
  NodeSet kept = all_nodes(graph);
  std::vector<std::size_t> deleted;
  while (true) {
    std::size_t worst = graph.nodes();
    double worst_weight = 0;
    for (std::size_t node = 0; node < graph.nodes(); ++node) {
      if (!holds(kept, node)) continue;
      Weight rivals = 0;
      std::uint64_t degree = 0;
      const auto row = graph.neighbours(node);
      for (std::size_t w = 0; w < kept.size(); ++w) {
        for (std::uint64_t set = row[w] & kept[w]; set != 0; set &= set - 1) {
          rivals += weights[64 * w + static_cast<std::size_t>(std::countr_zero(set))];
          ++degree;
        }
      }
      if (degree == 0) continue;
      // w_ext = deg / maxdeg * (1 - w) * sum of the neighbours' w; maxdeg is common to all and changes no comparison.
      const double extended =
          static_cast<double>(degree) * static_cast<double>(weight_one - weights[node]) * static_cast<double>(rivals);
      if (worst == graph.nodes() || extended >= worst_weight) {
        worst = node;
        worst_weight = extended;
      }
    }
    if (worst == graph.nodes()) break;
    erase(kept, worst);
    deleted.push_back(worst);
  }

  // Add back what was deleted for rivals that were deleted later.
  std::sort(deleted.begin(), deleted.end(),
            [&](std::size_t a, std::size_t b) { return weights[a] != weights[b] ? weights[a] > weights[b] : a < b; });
  for (const std::size_t node : deleted) {
    if (degree_in(graph, kept, node) == 0) insert(kept, node);
  }
  return kept;
}

}  // namespace silvasim::population
