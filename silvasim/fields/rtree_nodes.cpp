#include "silvasim/fields/rtree_nodes.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

namespace silvasim::fields {

namespace {

constexpr std::size_t head_bytes = 4;   // depth (of the root), number of cells
constexpr std::size_t cell_bytes = 24;  // id, then least and most x, least and most y as floats; all big-endian

struct Cell {
  std::int64_t id = 0;
  float least_x = 0, most_x = 0, least_y = 0, most_y = 0;
};

float below(double value) {
  const float f = static_cast<float>(value);
  return f > value ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}

float above(double value) {
  const float f = static_cast<float>(value);
  return f < value ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
}

// Every second bit, for a Morton number.
std::uint32_t spread(std::uint32_t bits16) {
  std::uint32_t v = bits16 & 0xffffu;
  v = (v | (v << 8)) & 0x00ff00ffu;
  v = (v | (v << 4)) & 0x0f0f0f0fu;
  v = (v | (v << 2)) & 0x33333333u;
  return (v | (v << 1)) & 0x55555555u;
}

void put(std::uint8_t*& to, std::uint64_t value, int bytes) {
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) *to++ = static_cast<std::uint8_t>(value >> shift);
}

void put(std::uint8_t*& to, const Cell& cell) {
  put(to, static_cast<std::uint64_t>(cell.id), 8);
  for (const float side : {cell.least_x, cell.most_x, cell.least_y, cell.most_y})
    put(to, std::bit_cast<std::uint32_t>(side), 4);
}

Cell around(std::span<const Cell> cells, std::int64_t id) {
  Cell box = cells.front();
  box.id = id;
  for (const Cell& cell : cells) {
    box.least_x = std::min(box.least_x, cell.least_x);
    box.most_x = std::max(box.most_x, cell.most_x);
    box.least_y = std::min(box.least_y, cell.least_y);
    box.most_y = std::max(box.most_y, cell.most_y);
  }
  return box;
}

std::vector<Cell> sorted_cells(std::span<const double> x, std::span<const double> y) {
  double west = INFINITY, east = -INFINITY, south = INFINITY, north = -INFINITY;
  const auto has_point = [&](std::size_t i) { return std::isfinite(x[i]) && std::isfinite(y[i]); };
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!has_point(i)) continue;
    west = std::min(west, x[i]);
    east = std::max(east, x[i]);
    south = std::min(south, y[i]);
    north = std::max(north, y[i]);
  }
  const double side = std::max({east - west, north - south, 1e-300});
  std::vector<std::uint64_t> order;
  order.reserve(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!has_point(i)) continue;
    const auto column = static_cast<std::uint32_t>((x[i] - west) / side * 65535),
               row = static_cast<std::uint32_t>((y[i] - south) / side * 65535);
    order.push_back((std::uint64_t{spread(column) | (spread(row) << 1)} << 32) | i);
  }
  std::sort(order.begin(), order.end());
  std::vector<Cell> cells;
  cells.reserve(order.size());
  for (const std::uint64_t entry : order) {
    const std::size_t i = entry & 0xffffffffu;
    cells.push_back({static_cast<std::int64_t>(i) + 1, below(x[i]), above(x[i]), below(y[i]), above(y[i])});
  }
  return cells;
}

}  // namespace

RtreeNodes rtree_nodes(std::span<const double> x, std::span<const double> y, std::size_t node_bytes) {
  assert(x.size() == y.size() && node_bytes > head_bytes + cell_bytes);
  const std::size_t fan_out = (node_bytes - head_bytes) / cell_bytes;
  RtreeNodes tree;
  tree.node_bytes = node_bytes;
  tree.leaf.assign(x.size(), 0);
  tree.parent.assign(2, 0);
  tree.data.assign(node_bytes, 0);  // the root's place

  std::vector<Cell> level = sorted_cells(x, y);
  std::uint64_t depth = 0;
  const auto write_node = [&](std::int64_t node, std::span<const Cell> cells, std::uint64_t node_depth) {
    std::uint8_t* to = tree.data.data() + static_cast<std::size_t>(node - 1) * node_bytes;
    put(to, node_depth, 2);
    put(to, cells.size(), 2);
    for (const Cell& cell : cells) {
      put(to, cell);
      (depth == 0 ? tree.leaf[static_cast<std::size_t>(cell.id - 1)] : tree.parent[static_cast<std::size_t>(cell.id)]) =
          node;
    }
  };
  // Bottom up: pack a level's cells into nodes of equal size, until one node, the root, holds them all.
  while (level.size() > fan_out) {
    const std::size_t nodes = (level.size() + fan_out - 1) / fan_out;
    std::vector<Cell> upper;
    for (std::size_t k = 0; k < nodes; ++k) {
      const std::size_t first = level.size() * k / nodes, last = level.size() * (k + 1) / nodes;
      const auto node = static_cast<std::int64_t>(tree.data.size() / node_bytes) + 1;
      tree.data.resize(tree.data.size() + node_bytes, 0);
      tree.parent.push_back(0);
      const auto cells = std::span<const Cell>(level).subspan(first, last - first);
      write_node(node, cells, 0);
      upper.push_back(around(cells, node));
    }
    level = std::move(upper);
    ++depth;
  }
  write_node(1, level, depth);
  return tree;
}

}  // namespace silvasim::fields
