#include <algorithm>
#include <cassert>

#include "ghosttile/density/kernels.h"
#include "ghosttile/density/program.h"

namespace ghosttile::density {

namespace {

void run(const Program& program, const Points& points, Scratch& scratch, float* value) {
  const std::size_t count = points.count;
  // The stack's lowest column is the result's.
  const std::size_t planes_from = program.deepest - 1, places_from = planes_from + program.slots;
  const std::size_t columns = places_from + 3 * std::size_t{program.moved};
  if (scratch.columns.size() < columns * block_size) scratch.columns.resize(columns * block_size);
  float* const room = scratch.columns.data();
  const auto stack = [&](std::size_t k) { return k == 0 ? value : room + (k - 1) * block_size; };
  const auto slot = [&](std::size_t k) { return room + (planes_from + k) * block_size; };
  std::size_t height = 0, warps = 0;
  const auto places = [&](std::size_t warp) -> Points {
    if (warp == 0) return points;
    float* x = room + (places_from + 3 * (warp - 1)) * block_size;
    return {x, x + block_size, x + 2 * block_size, count};
  };
  Points at = points;
  for (const Step& step : program.steps) {
    float* const top = height > 0 ? stack(height - 1) : nullptr;
    float* const next = stack(height);
    switch (step.code) {
      case Code::constant:
        std::fill_n(next, count, step.p[0]);
        ++height;
        break;
      case Code::point:
        point_squares(at, step.p, next);
        ++height;
        break;
      case Code::line:
        line_squares(at, step.p, next);
        ++height;
        break;
      case Code::disc:
        disc_squares(at, step.p, next);
        ++height;
        break;
      case Code::box:
        box_squares(at, step.p, next);
        ++height;
        break;
      case Code::cylinder:
        cylinder_squares(at, step.p, next);
        ++height;
        break;
      case Code::sphere:
        sphere_squares(at, step.p, next);
        ++height;
        break;
      case Code::layer:
        layer_squares(at, slot(step.slot), program.corner.z, step.p, next);
        ++height;
        break;
      case Code::above:
        values_above(at, slot(step.slot), program.corner.z, step.p[0], next);
        ++height;
        break;
      case Code::column:
        values_of_plane(slot(step.slot), count, next);
        ++height;
        break;
      case Code::smooth:
        smooth_falloff(step.p[0], count, top);
        break;
      case Code::cored:
        cored_falloff(step.p[0], step.p[1], count, top);
        break;
      case Code::sharp:
        sharp_falloff(step.p[0], count, top);
        break;
      case Code::cap:
        cap(count, top);
        break;
      case Code::scale:
        multiply(step.p[0], count, top);
        break;
      case Code::add:
        add(top, count, stack(--height - 1));
        break;
      case Code::greatest:
        keep_greatest(top, count, stack(--height - 1));
        break;
      case Code::least:
        keep_least(top, count, stack(--height - 1));
        break;
      case Code::take:
        take_away(top, count, stack(--height - 1));
        break;
      case Code::times:
        multiply(top, count, stack(--height - 1));
        break;
      case Code::sample:
        program.tree->planes[step.plane]->sample(program.corner, at.x, at.y, count, slot(step.slot));
        break;
      case Code::enter_warp: {
        float* x = room + (places_from + 3 * warps++) * block_size;
        moved_places(at, {step.slot, step.cell, {step.p[2], step.p[3], step.p[4]}, step.p[0], step.p[1]}, x,
                     x + block_size, x + 2 * block_size);
        at = places(warps);
        break;
      }
      case Code::leave_warp:
        at = places(--warps);
        break;
    }
  }
}

}  // namespace

void Compiled::evaluate(const Points& points, Scratch& scratch, float* value) const {
  assert(points.count <= block_size);
  if (program_) {
    run(*program_, points, scratch, value);
  } else {
    std::fill_n(value, points.count, range.least);
  }
}

}  // namespace ghosttile::density
