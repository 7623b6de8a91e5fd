// Which nodes may stay: against brute force, against dynamic programming on trees, and against the paper's formula.
#include "silvasim/population/independent_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace silvasim::population {
namespace {

using Random = std::mt19937_64;

std::uint64_t below(Random& random, std::uint64_t bound) { return random() % bound; }
double share(Random& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

Graph arbitrary_graph(Random& random, std::size_t nodes, double density) {
  Graph graph(nodes);
  for (std::size_t a = 0; a < nodes; ++a) {
    for (std::size_t b = a + 1; b < nodes; ++b) {
      if (share(random) < density) graph.add_edge(a, b);
    }
  }
  return graph;
}

// Discs thrown into a square, with weights probability * radius / Rmax, as at a vertex of a tiling.
struct DiscGraph {
  Graph graph;
  std::vector<Weight> weights;
};

DiscGraph disc_graph(Random& random, std::size_t nodes, double side) {
  DiscGraph discs{Graph(nodes), {}};
  std::vector<std::array<double, 3>> disc(nodes);
  for (auto& d : disc) d = {side * share(random), side * share(random), 0.25 + 0.75 * share(random)};
  for (std::size_t a = 0; a < nodes; ++a) {
    discs.weights.push_back(static_cast<Weight>(share(random) * disc[a][2] * static_cast<double>(weight_one)));
    for (std::size_t b = a + 1; b < nodes; ++b) {
      if (std::hypot(disc[a][0] - disc[b][0], disc[a][1] - disc[b][1]) < disc[a][2] + disc[b][2])
        discs.graph.add_edge(a, b);
    }
  }
  return discs;
}

// Few different values, zero among them, so that ties abound.
std::vector<Weight> coarse_weights(Random& random, std::size_t nodes) {
  std::vector<Weight> weights(nodes);
  for (Weight& w : weights) w = below(random, 5) * (weight_one / 4);
  return weights;
}

std::vector<Weight> fine_weights(Random& random, std::size_t nodes) {
  std::vector<Weight> weights(nodes);
  for (Weight& w : weights) w = below(random, weight_one + 1);
  return weights;
}

bool holds(const NodeSet& set, std::size_t node) { return set[node / 64] >> (node % 64) & 1; }

Weight weight_of(const NodeSet& set, const std::vector<Weight>& weights) {
  Weight sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) sum += holds(set, i) ? weights[i] : 0;
  return sum;
}

testing::AssertionResult independent_and_maximal(const Graph& graph, const NodeSet& set) {
  for (std::size_t a = 0; a < graph.nodes(); ++a) {
    bool rival_stays = false;
    for (std::size_t b = 0; b < graph.nodes(); ++b) rival_stays |= b != a && graph.adjacent(a, b) && holds(set, b);
    if (holds(set, a) && rival_stays) return testing::AssertionFailure() << "node " << a << " stays beside a rival";
    if (!holds(set, a) && !rival_stays) return testing::AssertionFailure() << "node " << a << " went for nothing";
  }
  for (std::size_t bit = graph.nodes(); bit < 64 * set.size(); ++bit) {
    if (holds(set, bit)) return testing::AssertionFailure() << "bit " << bit << " is no node";
  }
  return testing::AssertionSuccess();
}

// Tries all sets; of equals the one that holds the lowest node in which they differ.
NodeSet brute_force(const Graph& graph, const std::vector<Weight>& weights) {
  std::uint32_t best = 0;
  Weight best_weight = 0;
  for (std::uint32_t set = 0; set < (1u << graph.nodes()); ++set) {
    bool independent = true;
    Weight weight = 0;
    for (std::size_t i = 0; i < graph.nodes() && independent; ++i) {
      if (!(set >> i & 1)) continue;
      weight += weights[i];
      independent = (graph.neighbours(i)[0] & set) == 0;
    }
    if (!independent || weight < best_weight) continue;
    const std::uint32_t differing = set ^ best, lowest = differing & (0u - differing);
    if (weight > best_weight || (set & lowest)) {
      best = set;
      best_weight = weight;
    }
  }
  return {best};
}

TEST(OptimalSet, EqualsBruteForceOnArbitraryGraphs) {
  const std::uint64_t seed = 20131;
  SCOPED_TRACE("seed " + std::to_string(seed));
  Random random(seed);
  for (int round = 0; round < 1500; ++round) {
    const std::size_t nodes = 1 + below(random, round < 1400 ? 11 : 16);
    const Graph graph = arbitrary_graph(random, nodes, share(random));
    const auto weights = round % 2 ? coarse_weights(random, nodes) : fine_weights(random, nodes);
    const auto set = optimal_set(graph, weights);
    ASSERT_TRUE(set.has_value());
    ASSERT_EQ(*set, brute_force(graph, weights)) << "round " << round << ", " << nodes << " nodes";
    ASSERT_TRUE(independent_and_maximal(graph, *set)) << "round " << round;
  }
}

TEST(OptimalSet, EqualsBruteForceOnDiscs) {
  const std::uint64_t seed = 20132;
  SCOPED_TRACE("seed " + std::to_string(seed));
  Random random(seed);
  for (int round = 0; round < 400; ++round) {
    const std::size_t nodes = 1 + below(random, round < 350 ? 12 : 16);
    const DiscGraph discs = disc_graph(random, nodes, 1 + 4 * share(random));
    ASSERT_EQ(*optimal_set(discs.graph, discs.weights), brute_force(discs.graph, discs.weights)) << "round " << round;
  }
}

// Past the reach of brute force: on trees, dynamic programming gives the greatest weight in one sweep.
TEST(OptimalSet, EqualsDynamicProgrammingOnTreesOf64Nodes) {
  const std::uint64_t seed = 20133;
  SCOPED_TRACE("seed " + std::to_string(seed));
  Random random(seed);
  for (int round = 0; round < 200; ++round) {
    const std::size_t nodes = 17 + below(random, 48);
    Graph graph(nodes);
    std::vector<std::size_t> parent(nodes, 0);
    // Half of the trees are long and thin.
    for (std::size_t i = 1; i < nodes; ++i) {
      parent[i] = round % 2 ? below(random, i) : i - 1 - below(random, std::min<std::size_t>(i, 3));
      graph.add_edge(i, parent[i]);
    }
    const auto weights = round % 3 ? fine_weights(random, nodes) : coarse_weights(random, nodes);
    std::vector<Weight> with = weights, without(nodes, 0);
    for (std::size_t i = nodes - 1; i > 0; --i) {
      with[parent[i]] += without[i];
      without[parent[i]] += std::max(with[i], without[i]);
    }
    const auto set = optimal_set(graph, weights);
    ASSERT_TRUE(set.has_value()) << "round " << round;
    ASSERT_EQ(weight_of(*set, weights), std::max(with[0], without[0])) << "round " << round;
    ASSERT_TRUE(independent_and_maximal(graph, *set));
  }
}

TEST(OptimalSet, IsNoWorseThanTheHeuristicsUpTo64Nodes) {
  const std::uint64_t seed = 20134;
  SCOPED_TRACE("seed " + std::to_string(seed));
  Random random(seed);
  for (int round = 0; round < 150; ++round) {
    const std::size_t nodes = 17 + below(random, 48);
    const DiscGraph discs = disc_graph(random, nodes, 3 + 6 * share(random));
    const auto best = optimal_set(discs.graph, discs.weights);
    ASSERT_TRUE(best.has_value());
    ASSERT_TRUE(independent_and_maximal(discs.graph, *best));
    EXPECT_GE(weight_of(*best, discs.weights), weight_of(greedy_set(discs.graph, discs.weights), discs.weights));
    EXPECT_GE(weight_of(*best, discs.weights), weight_of(paper_set(discs.graph, discs.weights), discs.weights));
  }
}

TEST(OptimalSet, GivesUpWhenTheStepsAreUsedUp) {
  Random random(1);
  const Graph graph = arbitrary_graph(random, 64, 0.1);
  const auto weights = fine_weights(random, 64);
  EXPECT_FALSE(optimal_set(graph, weights, 10).has_value());
  EXPECT_TRUE(optimal_set(graph, weights).has_value());
}

TEST(OptimalSet, KnowsTheSmallestGraphs) {
  EXPECT_EQ(*optimal_set(Graph(0), {}), NodeSet{});
  EXPECT_EQ(*optimal_set(Graph(1), std::vector<Weight>{0}), NodeSet{1});
  Graph pair(2);
  pair.add_edge(0, 1);
  EXPECT_EQ(*optimal_set(pair, std::vector<Weight>{5, 5}), NodeSet{1});
  EXPECT_EQ(*optimal_set(pair, std::vector<Weight>{5, 6}), NodeSet{2});
  EXPECT_EQ(*optimal_set(Graph(64), std::vector<Weight>(64, 1)), NodeSet{~std::uint64_t{0}});
}

TEST(Heuristics, AreIndependentAndMaximalAtEverySize) {
  const std::uint64_t seed = 20135;
  SCOPED_TRACE("seed " + std::to_string(seed));
  Random random(seed);
  for (int round = 0; round < 300; ++round) {
    const std::size_t nodes = 1 + below(random, 200);
    const Graph graph = arbitrary_graph(random, nodes, share(random) * share(random));
    const auto weights = round % 2 ? coarse_weights(random, nodes) : fine_weights(random, nodes);
    ASSERT_TRUE(independent_and_maximal(graph, greedy_set(graph, weights))) << "round " << round;
    ASSERT_TRUE(independent_and_maximal(graph, paper_set(graph, weights))) << "round " << round;
  }
}

// The paper's formula, letter by letter: deg / maxdeg * (1 - w) * sum of the neighbours' w; nodes without edges leave.
NodeSet as_printed(const Graph& graph, const std::vector<Weight>& weights) {
  std::vector<bool> in(graph.nodes(), true), kept(graph.nodes(), false);
  const auto w = [&](std::size_t i) { return static_cast<double>(weights[i]) / static_cast<double>(weight_one); };
  while (true) {
    std::vector<int> degree(graph.nodes(), 0);
    for (std::size_t a = 0; a < graph.nodes(); ++a) {
      for (std::size_t b = 0; b < graph.nodes(); ++b) degree[a] += in[a] && in[b] && graph.adjacent(a, b);
      if (in[a] && degree[a] == 0) {
        in[a] = false;
        kept[a] = true;
      }
    }
    const int most = *std::max_element(degree.begin(), degree.end());
    if (most == 0) break;
    std::size_t worst = 0;
    double worst_weight = -1;
    for (std::size_t a = 0; a < graph.nodes(); ++a) {
      if (!in[a]) continue;
      double sum = 0;
      for (std::size_t b = 0; b < graph.nodes(); ++b) sum += in[b] && graph.adjacent(a, b) ? w(b) : 0;
      const double extended = static_cast<double>(degree[a]) / most * (1 - w(a)) * sum;
      if (extended > worst_weight) {
        worst = a;
        worst_weight = extended;
      }
    }
    in[worst] = false;
  }
  NodeSet set((graph.nodes() + 63) / 64);
  for (std::size_t i = 0; i < graph.nodes(); ++i) {
    if (kept[i]) set[i / 64] |= std::uint64_t{1} << (i % 64);
  }
  return set;
}

TEST(PaperSet, IsThePrintedHeuristicAndWhatItForgot) {
  const std::uint64_t seed = 20136;
  SCOPED_TRACE("seed " + std::to_string(seed));
  Random random(seed);
  int forgotten = 0;
  for (int round = 0; round < 2000; ++round) {
    const std::size_t nodes = 2 + below(random, 25);
    const Graph graph = arbitrary_graph(random, nodes, 0.05 + 0.5 * share(random));
    const auto weights = fine_weights(random, nodes);
    const NodeSet printed = as_printed(graph, weights), ours = paper_set(graph, weights);
    ASSERT_EQ(printed[0] & ~ours[0], 0u) << "round " << round << ": a node that the paper keeps is gone";
    if (independent_and_maximal(graph, printed)) {
      ASSERT_EQ(printed, ours) << "round " << round;
    } else {
      ++forgotten;
      ASSERT_NE(printed, ours) << "round " << round;
      ASSERT_TRUE(independent_and_maximal(graph, ours)) << "round " << round;
    }
  }
  // D2: without such graphs this test would not have tried the adding back.
  EXPECT_GT(forgotten, 0);
}

TEST(PaperSet, OfEqualsTheLowerNodeStays) {
  Graph pair(2);
  pair.add_edge(0, 1);
  EXPECT_EQ(paper_set(pair, std::vector<Weight>{7, 7}), NodeSet{1});
  EXPECT_EQ(paper_set(pair, std::vector<Weight>{weight_one, weight_one}), NodeSet{1});
  EXPECT_EQ(paper_set(pair, std::vector<Weight>{0, 0}), NodeSet{1});
  EXPECT_EQ(greedy_set(pair, std::vector<Weight>{7, 7}), NodeSet{1});
}

// D1: with weights in [0,1] the paper's heuristic comes within a few percent of the optimum on discs.
TEST(PaperSet, ComesCloseToTheOptimumOnDiscs) {
  const std::uint64_t seed = 20137;
  SCOPED_TRACE("seed " + std::to_string(seed));
  Random random(seed);
  double best = 0, paper = 0, greedy = 0;
  for (int round = 0; round < 3000; ++round) {
    const DiscGraph discs = disc_graph(random, 2 + below(random, 17), 2.5);
    best += static_cast<double>(weight_of(*optimal_set(discs.graph, discs.weights), discs.weights));
    paper += static_cast<double>(weight_of(paper_set(discs.graph, discs.weights), discs.weights));
    greedy += static_cast<double>(weight_of(greedy_set(discs.graph, discs.weights), discs.weights));
  }
  std::cout << "share of the optimum: paper " << paper / best << ", greedy " << greedy / best << '\n';
  EXPECT_GT(paper / best, 0.9);
  EXPECT_GT(greedy / best, 0.9);
}

}  // namespace
}  // namespace silvasim::population
