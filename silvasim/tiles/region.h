// A part of the plane made of disjoint boxes, to draw uniform points from.
#pragma once

#include <vector>

#include "silvasim/base/geometry.h"
#include "silvasim/base/random.h"

namespace silvasim::tiles {

// Boxes are half open: west and south belong to them, east and north do not.
class Region {
 public:
  // All boxes between neighbouring `columns` (x) and `rows` (y), both ascending, whose middle satisfies `inside`.
  template <typename Inside>
  Region(const std::vector<double>& columns, const std::vector<double>& rows, Inside&& inside) {
    for (std::size_t r = 0; r + 1 < rows.size(); ++r) {
      for (std::size_t c = 0; c + 1 < columns.size(); ++c) {
        const base::Point middle{0.5 * (columns[c] + columns[c + 1]), 0.5 * (rows[r] + rows[r + 1])};
        if (inside(middle)) add({columns[c], rows[r], columns[c + 1], rows[r + 1]});
      }
    }
  }
  explicit Region(const base::Box& box) { add(box); }

  double area_m2() const { return area_; }
  const base::Box& bounds() const { return bounds_; }

  // A uniform point. The region must not be empty.
  base::Point draw(base::Stream& random) const;
  bool contains(base::Point point) const;

 private:
  void add(const base::Box& box);

  std::vector<base::Box> boxes_;
  base::Box bounds_;
  double area_ = 0;
};

}  // namespace silvasim::tiles
