// The ground under the plants: relief in soft light from the north-west, with a faint tint by height.
//
// Where the terrain's cells are finer than the picture's pixels they are averaged, where they are coarser the light is
// spread smoothly between them. Gentle land is raised so that its forms show (up to six times), steep land is not.
// No data, flat land and land beyond the terrain: plain paper.
// Threads: works in parallel inside; light_at() may be called from any thread.
#pragma once

#include <vector>

#include "silvasim/ecosystem/ecosystem.h"
#include "silvasim/export/colour.h"
#include "silvasim/export/view.h"

namespace silvasim::exports {

inline constexpr Colour paper_colour = 0xF4F1EA;

class Ground {
 public:
  Ground(const ecosystem::Terrain& terrain, const View& view);

  struct Sample {
    Light light;
    float shade = 1;  // brightness against level ground, for what grows there
  };
  Sample at(double x, double y) const;  // scene point

  bool plain() const { return columns_ == 0; }

 private:
  int columns_ = 0, rows_ = 0;
  double west_ = 0, north_ = 0, cell_width_ = 1, cell_height_ = 1;
  float lowest_ = 0, range_ = 1;
  std::vector<float> heights_, shades_;
};

}  // namespace silvasim::exports
