// What the steps of a field do with columns: plain loops that vectorise, one call a block. See program.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "ghosttile/density/field.h"

namespace ghosttile::density {

using Parameters = std::array<float, 12>;

// Squares of distances in metres; p as compile.cpp fills it.
void point_squares(const Points& at, const Parameters& p, float* result);
void line_squares(const Points& at, const Parameters& p, float* result);
void disc_squares(const Points& at, const Parameters& p, float* result);
void box_squares(const Points& at, const Parameters& p, float* result);
void cylinder_squares(const Points& at, const Parameters& p, float* result);
void sphere_squares(const Points& at, const Parameters& p, float* result);
void layer_squares(const Points& at, const float* plane, double corner_z_m, const Parameters& p, float* result);

// Values.
void values_above(const Points& at, const float* plane, double corner_z_m, float from_m, float* result);
void values_of_plane(const float* plane, std::size_t count, float* result);
void smooth_falloff(float per_square, std::size_t count, float* column);
void cored_falloff(float per_metre, float core, std::size_t count, float* column);
void sharp_falloff(float square, std::size_t count, float* column);

// One column put together with another.
void add(const float* other, std::size_t count, float* column);
void keep_greatest(const float* other, std::size_t count, float* column);
void keep_least(const float* other, std::size_t count, float* column);
void take_away(const float* other, std::size_t count, float* column);
void multiply(const float* other, std::size_t count, float* column);
void cap(std::size_t count, float* column);
void multiply(float by, std::size_t count, float* column);

struct Noise {
  std::uint32_t key = 0;
  std::array<std::uint32_t, 3> cell{};  // of the corner
  std::array<float, 3> within{};        // of the corner in its cell
  float per_metre = 1, far_m = 0;
};

// Places moved by value noise, by at most far_m along each axis: smooth in the place (C2), different for each key.
void moved_places(const Points& at, const Noise& noise, float* x, float* y, float* z);

}  // namespace ghosttile::density
