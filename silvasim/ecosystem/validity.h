// What an ecosystem must fulfil to be written, and what a reader may rely on. Each function returns what is wrong in
// words that fit after "cannot write: " or "chunk SPEC at byte 1234: ", or an empty string.
#pragma once

#include <string>
#include <vector>

#include "silvasim/ecosystem/ecosystem.h"

namespace silvasim::ecosystem {

// Name, CRS and extent: UTF-8, a finite box that is not empty, within 10^9 m of the origin.
std::string problem_with_frame(const Ecosystem& ecosystem);
// One JSON object, at most 64 levels deep.
std::string problem_with_provenance(const std::string& json);
// Without the heights: 0 x 0 or both sides > 0, finite corner (within 10^9 m) and cells.
std::string problem_with_grid(const Terrain& terrain);
// Finite or NaN.
std::string problem_with_heights(const std::vector<float>& heights_m);
// A layer's own name and corner, within 10^9 m of the origin.
std::string problem_with_head(const Layer& layer);
// UTF-8, unique names, positive sizes, ordered scale range, fewer than `no_plant`.
std::string problem_with(const std::vector<Species>& species);
// Tiles in their order, sites within the tile, radii in (0, Rmax], all finite.
std::string problem_with(const tiles::TileSet& set);
// Tile indices in range; colours of touching edges agree.
std::string problem_with(const tiles::Tiling& tiling, const tiles::TileSet& set);
// 0 x 0 and empty, or both sides > 0, a corner and cells as a terrain's, and a share a species and cell.
std::string problem_with(const SuitabilityMap& map, std::size_t species);

// All of the above, and plants and probabilities for every site, with ids in range.
std::string problem_with(const Ecosystem& ecosystem);

}  // namespace silvasim::ecosystem
