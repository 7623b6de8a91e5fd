// A whole R-tree for points at once, as the node table of SQLite's rtree module holds it. Row by row SQLite takes 20
// microseconds a point.
//
// Source: the layout of a node as sqlite.org/src/file/ext/rtree/rtree.c describes it (SQLite 3.6 and later); SQLite's
// rtreecheck() proves the result in the tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace silvasim::fields {

struct RtreeNodes {
  std::size_t node_bytes = 0;  // of each node; node k (from 1, the root) starts at (k - 1) * node_bytes
  std::vector<std::uint8_t> data;
  std::vector<std::int64_t> parent;  // parent[k] of node k; the root's and [0] are 0
  std::vector<std::int64_t> leaf;    // leaf[i]: the node that holds row i + 1; 0: that row has no point
};

// A tree over points whose row ids are their index + 1. Rows whose coordinates are not finite stay out of it.
//
// node_bytes: as SQLite chose it for the table, 4 + a multiple of 24. Neighbours share nodes, by Morton order.
RtreeNodes rtree_nodes(std::span<const double> x, std::span<const double> y, std::size_t node_bytes);

}  // namespace silvasim::fields
