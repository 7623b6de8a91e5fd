// Independent sets of great weight in small graphs: which nodes may stay so that no two neighbours do.
//
// Weights are whole numbers, so that sums are exact and ties are ties on every machine. Of equals the lower node stays.
// Promise: every set returned is independent and maximal (nothing could be added); same arguments, same set.
// Threads: independent calls may run side by side.
// Source: Silva 2013, section 4.4 (the heuristic); docs/reading.md, D1 to D3.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace silvasim::population {

// Undirected, without loops; one row of bits a node.
class Graph {
 public:
  explicit Graph(std::size_t nodes) : nodes_(nodes), words_((nodes + 63) / 64), bits_(nodes * words_) {}

  std::size_t nodes() const { return nodes_; }
  void add_edge(std::size_t a, std::size_t b) {
    bits_[a * words_ + b / 64] |= std::uint64_t{1} << (b % 64);
    bits_[b * words_ + a / 64] |= std::uint64_t{1} << (a % 64);
  }
  bool adjacent(std::size_t a, std::size_t b) const { return bits_[a * words_ + b / 64] >> (b % 64) & 1; }
  std::span<const std::uint64_t> neighbours(std::size_t a) const { return {bits_.data() + a * words_, words_}; }

 private:
  std::size_t nodes_, words_;
  std::vector<std::uint64_t> bits_;
};

// A node's weight as a share of `weight_one`; at most `weight_one`.
using Weight = std::uint64_t;
inline constexpr Weight weight_one = Weight{1} << 32;

// The nodes that stay, as bits: node i is bit i % 64 of word i / 64.
using NodeSet = std::vector<std::uint64_t>;

inline constexpr std::size_t most_exact_nodes = 64;

// The set of greatest weight; among several, the one that holds the lowest node in which they differ. Branch and bound
// with a clique cover as bound. None when `most_steps` do not suffice. Needs graph.nodes() <= most_exact_nodes.
std::optional<NodeSet> optimal_set(const Graph& graph, std::span<const Weight> weights,
                                   std::uint64_t most_steps = 1'000'000);

// Takes the node of greatest weight / (degree + 1), drops its neighbours, and so on.
NodeSet greedy_set(const Graph& graph, std::span<const Weight> weights);

// The paper's heuristic: deletes the node of greatest w_ext until no edge is left, then adds back the deleted nodes
// whose rivals were all deleted too, heaviest first (D2).
NodeSet paper_set(const Graph& graph, std::span<const Weight> weights);

}  // namespace silvasim::population
