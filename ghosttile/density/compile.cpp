// From items to steps: parameters become floats relative to the corner.
#include <cmath>

#include "ghosttile/density/program.h"

namespace ghosttile::density {

namespace {

float f(double x) { return static_cast<float>(x); }

class Compiler {
 public:
  Compiler(Program& program, const std::vector<Item>& items) : program_(program), items_(items) {}

  // Leaves one column more on the stack.
  void add(std::size_t at) {
    const Item& item = items_[at];
    if (item.kind == Kind::constant) {
      push(Code::constant).p[0] = item.value;
    } else if (item.kind == Kind::warp) {
      add_warp(item, at + 1);
    } else if (is_operator(item.kind)) {
      add_operator(item, at);
    } else {
      add_leaf(program_.tree->leaves[item.index]);
    }
  }

 private:
  struct Sampled {
    std::uint32_t plane, place;
  };

  Step& step(Code code) {
    program_.steps.emplace_back().code = code;
    return program_.steps.back();
  }
  Step& push(Code code) {
    if (++depth_ > program_.deepest) program_.deepest = depth_;
    return step(code);
  }

  void add_operator(const Item& item, std::size_t at) {
    static constexpr Code codes[] = {Code::add, Code::greatest, Code::least, Code::take, Code::times};
    bool first = true;
    for (std::size_t child = at + 1; child < at + item.span; child += items_[child].span) {
      add(child);
      if (!first) {
        step(codes[static_cast<std::size_t>(item.kind) - static_cast<std::size_t>(Kind::blend)]);
        --depth_;
      }
      first = false;
    }
    if (item.kind == Kind::blend) step(Code::cap);
    if (item.kind == Kind::scale) step(Code::scale).p[0] = item.value;
  }

  void add_warp(const Item& item, std::size_t child) {
    const Warp& warp = program_.tree->warps[item.index];
    Step& enter = step(Code::enter_warp);
    enter.slot = warp.key;
    enter.p[0] = f(1 / warp.wavelength_m);
    enter.p[1] = f(warp.far_m);
    for (int k = 0; k < 3; ++k) {
      // The corner's cell of the noise as an integer, and how far within it.
      const double cells = program_.corner[k] / warp.wavelength_m, cell = std::floor(cells);
      const double whole = cell - 0x1p32 * std::floor(cell * 0x1p-32);
      enter.cell[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(whole);
      enter.p[static_cast<std::size_t>(2 + k)] = f(cells - cell);
    }
    const std::uint32_t outside = place_;
    place_ = ++places_;
    if (++warps_ > program_.moved) program_.moved = warps_;
    add(child);
    step(Code::leave_warp);
    --warps_;
    place_ = outside;
  }

  std::uint32_t sampled(std::uint32_t plane) {
    for (std::size_t i = 0; i < sampled_.size(); ++i)
      if (sampled_[i].plane == plane && sampled_[i].place == place_) return static_cast<std::uint32_t>(i);
    Step& sample = step(Code::sample);
    sample.plane = plane;
    sample.slot = static_cast<std::uint32_t>(sampled_.size());
    sampled_.push_back({plane, place_});
    program_.slots = static_cast<std::uint32_t>(sampled_.size());
    return sample.slot;
  }

  void add_leaf(const Leaf& leaf) {
    const V3d at = leaf.at - program_.corner;
    switch (leaf.kind) {
      case Kind::point:
        push(Code::point).p = {f(at.x), f(at.y), f(at.z)};
        break;
      case Kind::sphere:
        push(Code::sphere).p = {f(at.x), f(at.y), f(at.z), f(leaf.size_m)};
        break;
      case Kind::segment:
      case Kind::cylinder: {
        // Measured from the line's place nearest to the corner, so that far ends cost no precision.
        const double u = -at.dot(leaf.axis);
        const V3d near = at + leaf.axis * u;
        push(leaf.kind == Kind::segment ? Code::line : Code::cylinder).p = {
            f(near.x),      f(near.y),      f(near.z), f(leaf.axis.x),
            f(leaf.axis.y), f(leaf.axis.z), f(-u),     f(leaf.length_m - u),
            f(leaf.size_m)};
        break;
      }
      case Kind::disc:
        push(Code::disc).p = {f(at.x),        f(at.y),        f(at.z),       f(leaf.axis.x),
                              f(leaf.axis.y), f(leaf.axis.z), f(leaf.size_m)};
        break;
      case Kind::box:
        push(Code::box).p = {f(at.x),          f(at.y),        f(at.z),        f(leaf.cos_turn),
                             f(leaf.sin_turn), f(leaf.half.x), f(leaf.half.y), f(leaf.half.z)};
        break;
      default: {
        const std::uint32_t slot = sampled(leaf.plane);
        Step& pushed = push(leaf.kind == Kind::layer   ? Code::layer
                            : leaf.kind == Kind::above ? Code::above
                                                       : Code::column);
        pushed.slot = slot;
        pushed.p = {f(leaf.from_m), f(0.5 * (leaf.from_m + leaf.to_m)), f(0.5 * (leaf.to_m - leaf.from_m))};
        if (leaf.kind != Kind::layer) return;
      }
    }
    if (leaf.sharp()) {
      step(Code::sharp).p[0] = f(leaf.radius_m * leaf.radius_m);
    } else if (leaf.core > 0) {
      step(Code::cored).p = {f(1 / (leaf.radius_m * (1 - leaf.core))), f(leaf.core / (1 - leaf.core))};
    } else {
      step(Code::smooth).p[0] = f(1 / (leaf.radius_m * leaf.radius_m));
    }
  }

  Program& program_;
  const std::vector<Item>& items_;
  std::vector<Sampled> sampled_;
  std::uint32_t depth_ = 0, place_ = 0, places_ = 0, warps_ = 0;
};

}  // namespace

std::shared_ptr<const Program> program_of(const std::shared_ptr<const Tree>& tree, const std::vector<Item>& items,
                                          const V3d& corner) {
  auto program = std::make_shared<Program>();
  program->tree = tree;
  program->corner = corner;
  program->steps.reserve(3 * items.size() + 2);
  Compiler(*program, items).add(0);
  return program;
}

}  // namespace ghosttile::density
