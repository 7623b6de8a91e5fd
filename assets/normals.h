// Normals of vertices: made where the file has none, and on the side that the triangle shows.
#pragma once

#include <cstddef>

#include "assets/draft.h"

namespace assets {

// Whether three points span more than a line: the least height is above 1e-6 of the longest side.
bool has_area(const V3& a, const V3& b, const V3& c);

// Gives each vertex a normal of unit length: the file's, or where that is zero the sum over the triangles around it (all
// vertices of one `smooth_with`), weighted by area. Returns how many of the file's normals were no numbers.
std::size_t make_normals(Draft& draft);

// Turns what lies: where the normals of a triangle's vertices point to its back, a two-sided triangle is turned over (leaf
// cards carry the normals of the crown, which is what lights them), and a one-sided one gets vertices with normals of
// the other sign.
void face_normals(Model& model);

}  // namespace assets
