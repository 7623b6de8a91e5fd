// How well the place suits the shown species, to be drawn: the largest of their shares at each point of the land.
//
// The layer of the smallest cells gives the grid; the cells of the others are repeated on it. A cell without sites takes
// the mean of its neighbours that have some. Between the cells values are spread by cubic B-splines: a cell averages a few
// sites, whose chance sizes would show as grain. Cells where nothing can grow stay apart, with a sharp rim: they darken no
// neighbour.
// Threads: at() may be called from any thread.
#pragma once

#include <string>
#include <vector>

#include "silvasim/ecosystem/ecosystem.h"
#include "silvasim/export/view.h"

namespace silvasim::exports {

class Heat {
 public:
  // Each shown layer must hold its map: take_census() sees to that.
  Heat(const ecosystem::Ecosystem& ecosystem, const Census& census);

  struct Sample {
    float share = 0;    // 0..1
    float opacity = 0;  // 0: nothing can grow there, or nobody knows; 1; between them at the rim
  };
  Sample at(double x, double y) const;

 private:
  int columns_ = 0, rows_ = 0;
  double west_ = 0, north_ = 0, cell_m_ = 1;
  std::vector<float> shares_;  // row by row; less than 0: unknown
};

// Mean share of a species over the part of the map that lies in the box; 0 where it holds no site.
double mean_suitability(const ecosystem::SuitabilityMap& map, std::size_t species, const base::Box& box);

// "suitability for Fagus sylvatica", "suitability for the best suited of 12 species".
std::string heat_title(const ecosystem::Ecosystem& ecosystem, const Census& census, const PreviewOptions& options);
std::string heat_caption(const ecosystem::Ecosystem& ecosystem, const Census& census);

}  // namespace silvasim::exports
