// Smooth noise over the land, a function of the place alone: what makes ground uneven.
// Threads: any. Cost: 20 ns.
#pragma once

#include <cstdint>

namespace silvavis::shade {

// In [0, 1], mean 0.5; features are about `size_m` wide. Value noise, three octaves. What is finer than a ray that is `width_m` wide
// evens out to its mean, so that nothing flickers, and costs nothing.
float patches(double x, double y, double size_m, double width_m = 0);

// What is random about a cell of a grid.
std::uint32_t place_hash(std::int32_t i, std::int32_t j);

// One octave of it.
float lumps(double x, double y, double size_m, double width_m = 0);

}  // namespace silvavis::shade
