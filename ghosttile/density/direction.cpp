#include "ghosttile/density/direction.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace ghosttile::density {

namespace {

using Column = std::array<float, block_size>;

// Unit vectors of three columns; 0 where they are no longer than `least`.
void normalized(const Column& x, const Column& y, const Column& z, std::size_t count, float least, V3* result) {
  for (std::size_t i = 0; i < count; ++i) {
    const float length = std::sqrt(x[i] * x[i] + y[i] * y[i] + z[i] * z[i]);
    const float per = length > least ? 1 / length : 0;
    result[i] = V3(x[i] * per, y[i] * per, z[i] * per);
  }
}

void moved(const float* from, float by_m, std::size_t count, Column& to) {
  for (std::size_t i = 0; i < count; ++i) to[i] = from[i] + by_m;
}

// Central differences of the density, turned round: it thins outward.
void outward(const Points& points, const Compiled& density, Scratch& scratch, V3* result) {
  std::array<Column, 3> slope;
  Column place, before, after;
  const std::array<const float*, 3> at{points.x, points.y, points.z};
  for (std::size_t k = 0; k < 3; ++k) {
    std::array<const float*, 3> there = at;
    there[k] = place.data();
    const Points other{there[0], there[1], there[2], points.count};
    moved(at[k], -gradient_step_m, points.count, place);
    density.evaluate(other, scratch, before.data());
    moved(at[k], gradient_step_m, points.count, place);
    density.evaluate(other, scratch, after.data());
    for (std::size_t i = 0; i < points.count; ++i) slope[k][i] = before[i] - after[i];
  }
  // A float's rounding over both steps is some 1e-7: less than this is no slope.
  normalized(slope[0], slope[1], slope[2], points.count, 1e-6f, result);
}

// Of a height plane, by central differences wide enough for floats of high mountains.
void ground_normals(const Plane& ground, const V3d& corner, const Points& points, V3* result) {
  constexpr float step_m = 0.25f;
  Column place, before, after, east, north, up;
  const auto rise = [&](Column& fall) {
    for (std::size_t i = 0; i < points.count; ++i) fall[i] = before[i] - after[i];
  };
  moved(points.x, -step_m, points.count, place);
  ground.sample(corner, place.data(), points.y, points.count, before.data());
  moved(points.x, step_m, points.count, place);
  ground.sample(corner, place.data(), points.y, points.count, after.data());
  rise(east);
  moved(points.y, -step_m, points.count, place);
  ground.sample(corner, points.x, place.data(), points.count, before.data());
  moved(points.y, step_m, points.count, place);
  ground.sample(corner, points.x, place.data(), points.count, after.data());
  rise(north);
  up.fill(2 * step_m);
  normalized(east, north, up, points.count, 0, result);
}

void around_axis(const V3d& centre, const V3d& corner, const Points& points, bool rotational, V3* result) {
  const float cx = static_cast<float>(centre.x - corner.x), cy = static_cast<float>(centre.y - corner.y);
  Column x, y, z;
  for (std::size_t i = 0; i < points.count; ++i) {
    const float dx = points.x[i] - cx, dy = points.y[i] - cy;
    x[i] = rotational ? -dy : dx;
    y[i] = rotational ? dx : dy;
    z[i] = 0;
  }
  normalized(x, y, z, points.count, 1e-6f, result);
}

}  // namespace

void directions_at(const Direction& direction, const V3d& corner, const Points& points, const Compiled& density,
                   Scratch& scratch, V3* result) {
  assert(points.count <= block_size);
  switch (direction.kind) {
    case DirectionKind::vertical:
      std::fill_n(result, points.count, V3(0, 0, 1));
      break;
    case DirectionKind::constant: {
      const double length = std::sqrt(direction.vector.dot(direction.vector));
      std::fill_n(result, points.count, length > 0 ? V3(direction.vector / length) : V3(0));
      break;
    }
    case DirectionKind::gradient:
      if (density.constant()) {
        std::fill_n(result, points.count, V3(0));
      } else {
        outward(points, density, scratch, result);
      }
      break;
    case DirectionKind::rotational:
    case DirectionKind::radial:
      around_axis(direction.centre, corner, points, direction.kind == DirectionKind::rotational, result);
      break;
    case DirectionKind::normal:
      if (direction.ground) {
        ground_normals(*direction.ground, corner, points, result);
      } else {
        std::fill_n(result, points.count, V3(0, 0, 1));
      }
  }
}

}  // namespace ghosttile::density
