// Fills a Wang tile set with variable-radius Poisson discs.
//
// Two modes. `paper` is Algorithm 1 of the paper: strips beside the edges are copied between tiles, and discs of different
// tiles may overlap near the tiling's vertices, which the corner graph mends after the plants are known. `seamless` shares
// one patch around every vertex, so that no tiling has an overlap; its price is that the patch repeats at every vertex.
//
// Promise: same settings, seed and layer, same bytes on any machine and with any number of threads. No two discs of one tile
//   overlap, in the floats as written. In mode `paper`, in any tiling, both discs of an overlapping pair lie within 4 Rmax
//   (Chebyshev) of one vertex, and strips are the same in all tiles that share the colour, farther than that from corners; in
//   mode `seamless` no two discs overlap. Radii follow the asked distribution; coverage is the asked one within a few
//   percent, less where a disc finds no room (small tiles near the limit of coverage, check.h).
// Errors: base::ConfigError with all faults() of the settings.
// Threads: works in parallel inside.
// Cost: 18 tiles of 126 sites 3 ms, of 21,000 sites 0.5 s, on one core of a small machine.
// Source: Silva 2013, Algorithm 1; docs/tiles.md.
#pragma once

#include <cstdint>

#include "silvasim/config/tile_settings.h"
#include "silvasim/tiles/tile_set.h"

namespace silvasim::tiles {

// `layer` keeps the random numbers of vegetation layers apart.
TileSet fill_tiles(const config::TileSettings& settings, std::uint64_t seed, std::uint32_t layer = 0);

// The colours of every tile, without sites (A1).
TileSet empty_tiles(const config::TileSettings& settings);

}  // namespace silvasim::tiles
