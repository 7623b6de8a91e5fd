// The legend: species with colour, names, counts and shares, grouped by vegetation layer; on probability maps the
// ramp, on maps of suitability means in place of counts.
//
// Entries stand by count (or mean), largest first. Up to twelve have two lines, more have one; what finds no room is summed up in
// a last line, "and 5 more species".
#pragma once

#include <vector>

#include "silvasim/export/layout.h"

namespace silvasim::exports {

class Legend {
 public:
  // `unit_px`: the picture's unit, 1 at a width of 1600.
  Legend(const ecosystem::Ecosystem& ecosystem, const Census& census, Subject subject, double unit_px);

  double height_px() const;                                      // of all rows in one column
  double natural_width_px() const { return natural_width_px_; }  // at which no name is cut
  // Draws columns of this width, one beside the other, and returns the y below the lowest row.
  double draw(Part& part, double x, double y, double column_px, int columns, double gap_px,
              double most_height_px) const;

 private:
  struct Row {
    enum class Kind { heading, entry, ramp, more };
    Kind kind = Kind::entry;
    std::string first, second;  // names: common and scientific, or heading
    Colour colour = 0;
    std::uint64_t plants = 0;
    std::string number;  // the count, or the mean suitability
    std::string aside;   // share, or mean probability
    bool apart = false;  // stands below entries, with room above
    bool faint = false;  // nothing of it is there
  };
  double height_px(const Row& row) const;
  void draw_row(Part& part, const Row& row, double x, double y, double width) const;
  void draw_entry(Part& part, const Row& row, double x, double y, double width) const;

  Subject subject_;
  double unit_px_ = 1;
  bool two_lines_ = true;
  double natural_width_px_ = 0, numbers_px_ = 0, asides_px_ = 0;
  std::vector<Row> rows_;
};

}  // namespace silvasim::exports
