// What is left of a field as a list of steps over columns: a stack machine whose stack holds columns.
//
// A distance step pushes the squares of distances in metres, a falloff step turns the top into values, an operator takes
// the top and puts it together with the one below.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "ghosttile/density/tree.h"

namespace ghosttile::density {

enum class Code : std::uint8_t {
  // push
  constant,
  point,
  line,
  disc,
  box,
  cylinder,
  sphere,
  layer,
  above,
  column,
  // change the top
  smooth,
  cored,
  sharp,
  cap,
  scale,
  // take the top away
  add,
  greatest,
  least,
  take,
  times,
  // where the following steps look
  sample,
  enter_warp,
  leave_warp,
};

struct Step {
  Code code = Code::constant;
  std::uint32_t slot = 0;   // column of a sampled plane; key of a warp's noise
  std::uint32_t plane = 0;  // into Tree::planes
  std::array<std::uint32_t, 3> cell{};
  std::array<float, 12> p{};
};

struct Program {
  std::shared_ptr<const Tree> tree;
  V3d corner{0, 0, 0};
  std::vector<Step> steps;
  std::uint32_t deepest = 0;  // columns of the stack
  std::uint32_t moved = 0;    // warps within warps
  std::uint32_t slots = 0;    // sampled planes
};

std::shared_ptr<const Program> program_of(const std::shared_ptr<const Tree>& tree, const std::vector<Item>& items,
                                          const V3d& corner);

}  // namespace ghosttile::density
