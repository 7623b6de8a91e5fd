// Smooth noise over the land, a function of the place alone: what makes ground uneven.
// Threads: any. Cost: 20 ns.
#pragma once

namespace silvavis::shade {

// In [0, 1], mean 0.5; features are about `size_m` wide. Value noise, three octaves.
float patches(double x, double y, double size_m);

}  // namespace silvavis::shade
