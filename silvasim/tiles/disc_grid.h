// Discs on a background grid, to ask quickly whether another one fits between them.
//
// The window closes on itself: what lies at its western rim presses on its eastern rim, and south on north. A window
// with open rims would gather large discs there, because nothing presses on them from outside. Cost: a question looks
// at the cells within reach, about ten discs; memory 24 bytes a disc and 4 a cell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "silvasim/base/geometry.h"

namespace silvasim::tiles {

struct Disc {
  double x = 0;
  double y = 0;
  double radius = 0;
};

class DiscGrid {
 public:
  // `most_radius`: no disc is larger. `gap`: discs keep this far apart, so that no rounding makes them overlap.
  // `spacing`: about the distance between neighbours, to choose the cells' size.
  DiscGrid(const base::Box& window, double most_radius, double gap, double spacing);

  bool fits(const Disc& disc) const;
  void add(const Disc& disc);  // inside the window or up to 2 most_radius outside

 private:
  struct Entry {
    Disc disc;
    std::int32_t next;
  };

  int column(double x) const;
  int row(double y) const;
  void insert(const Disc& disc);
  bool cell_fits(int column, int row, const Disc& disc) const;

  base::Box window_, bounds_;  // bounds: of the cells
  double most_radius_, gap_;
  double cell_ = 1;
  int columns_ = 1, rows_ = 1;
  std::vector<std::int32_t> first_;  // of each cell, -1: none
  std::vector<Entry> entries_;
};

}  // namespace silvasim::tiles
