// Solves the corner problem: removes plants until no two discs of different tiles overlap at the tiling's vertices,
// keeping those that are likely and cover much ground.
//
// Each vertex of the tiling is a problem of its own, because a tile's side is larger than 8 Rmax. Nodes are standing
// plants within 4 Rmax of the vertex (along x and along y) whose discs overlap, two of one tile too; their weight is
// probability * radius / Rmax. Sites without a plant leave first.
// Promise: the kept plants of a vertex are independent and maximal; same bytes whatever the threads. Farther than
//   4 Rmax from every vertex nothing is looked at: tiles::fill_tiles() promises that nothing overlaps there.
// Errors: base::Error when the tile's side is not larger than 8 Rmax.
// Threads: works in parallel inside.
// Cost: one pass over the vertices; 10,201 of them with 6,704 groups take about 5 ms of one core.
// Source: Silva 2013, section 4.4; docs/reading.md, D1 to D4.
#pragma once

#include <cstdint>
#include <span>

#include "silvasim/base/progress.h"
#include "silvasim/config/corner_settings.h"
#include "silvasim/ecosystem/ecosystem.h"

namespace silvasim::population {

struct CornerReport {
  std::uint64_t conflicts = 0;   // overlapping pairs of standing plants
  std::uint64_t components = 0;  // connected groups of them
  std::uint64_t largest = 0;     // plants in the largest group
  std::uint64_t fallbacks = 0;   // groups too large for the exact solver, solved by greedy w / (degree + 1)
  std::uint64_t removed = 0;     // plants that gave way
  double weight = 0;             // of all plants in conflict
  double kept_weight = 0;

  friend bool operator==(const CornerReport&, const CornerReport&) = default;
};

// `plants` and `probability`: one value per (tile position, site id), laid out by `offsets` =
// ecosystem::site_offsets(). Plants that give way become ecosystem::no_plant.
CornerReport prune_corners(const tiles::TileSet& set, const tiles::Tiling& tiling,
                           std::span<const std::uint64_t> offsets, std::span<ecosystem::PlantId> plants,
                           std::span<const float> probability, config::CornerSolver solver,
                           const base::Progress& progress = {});

}  // namespace silvasim::population
