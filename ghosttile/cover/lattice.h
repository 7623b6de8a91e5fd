// A source that is worked out on a lattice of fixed places in the land and read between them: for what is costly to ask for one
// point and cheap for many beside each other, such as crowns.
//
// Shape: nodes at whole multiples of `step_m` of the scene's coordinates; bilinear between. Blocks of 64 x 64 cells are filled when
//   they are first asked for and kept until there are too many. So a point's value depends on the place alone.
// Threads: any number; a block that two threads need at once may be worked out twice, with the same values.
// Cost: about 12 ns a point in a block that is there.
#pragma once

#include <cstdint>
#include <memory>

#include "ghosttile/cover/source.h"

namespace ghosttile::cover {

inline constexpr int block_cells = 64;
inline constexpr int block_nodes = block_cells + 1;  // along each side: neighbours share their rims

// Nodes of a block, row by row from the south.
struct NodeBlock {
  std::int64_t first_column = 0, first_row = 0;
  double step_m = 1;

  double x(int i) const { return static_cast<double>(first_column + i) * step_m; }
  double y(int j) const { return static_cast<double>(first_row + j) * step_m; }
  silvasim::base::Box box() const { return {x(0), y(0), x(block_cells), y(block_cells)}; }
  // Nodes between two coordinates, and maybe one more on each side; first > last: none.
  struct Span {
    int first, last;
  };
  Span columns(double west, double east) const { return span(west, east, first_column); }
  Span rows(double south, double north) const { return span(south, north, first_row); }

 private:
  Span span(double from, double to, std::int64_t first) const;
};

// What is put on a lattice.
class Filler {
 public:
  virtual ~Filler() = default;
  // values[block_nodes * block_nodes], each a pure function of its node's place. Finite.
  virtual void fill(const NodeBlock& block, float* values) const = 0;
  // All values that fill() may put on nodes in the box, and maybe more. Quick for boxes of any size.
  virtual Range range(const silvasim::base::Box& box) const = 0;
};

// `most_bytes` of blocks are kept.
std::shared_ptr<const Source> on_lattice(std::unique_ptr<const Filler> filler, double step_m, std::size_t most_bytes);

}  // namespace ghosttile::cover
