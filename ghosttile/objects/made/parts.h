// What the makers of details share: draws, closed tubes, and the last steps of every model.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "assets/grown/canvas.h"
#include "assets/grown/draws.h"
#include "assets/model.h"
#include "ghosttile/objects/made/made.h"

namespace ghosttile::objects::made {

using assets::Model;
using assets::Rgb;
using assets::V2;
using assets::V3;
using assets::grown::clamp01;
using assets::grown::mix;
using assets::grown::pi;
using assets::grown::sin_cos;
using assets::grown::SinCos;
using assets::grown::smooth;

class Draws {
 public:
  // `part` tells apart what is drawn for: another part's draws stay when this one's number changes.
  Draws(std::uint64_t seed, std::uint32_t part) : stream_(seed, silvasim::base::Purpose::detail_form, part) {}
  float share() { return stream_.next_float(); }
  float between(float low, float high) { return mix(low, high, share()); }
  float around(float centre, float spread) { return centre + spread * (2 * share() - 1); }
  float bell() { return 2 * (share() + share() + share() - 1.5f); }
  float sign() { return share() < 0.5f ? -1.0f : 1.0f; }
  V3 direction();

 private:
  silvasim::base::Stream stream_;
};

// Noise in [-1, 1] of octaves over the unit square, which repeats.
float rough(float u, float v, int cells_u, int cells_v, std::uint32_t salt);

// Returns its index. A texture's index may be assets::no_texture.
std::uint16_t add_material(Model& model, const std::string& name, const Rgb& reflectance, int texture);
int add_texture(Model& model, assets::grown::Canvas canvas, const std::string& name, bool has_alpha);

// A closed surface around rings of as many points, each anticlockwise seen from the tip, closed by a fan at either end.
struct Rings {
  std::vector<std::vector<V3>> rings;
  V3 foot, tip;
  std::vector<float> v;  // of the texture, by ring
  float v_foot = 0, v_tip = 1;
  float u_repeat = 1;
  std::uint16_t material = 0, cap_material = 0;
  bool hard_caps = false;  // cut ends: normals of their own
};
void add_rings(Model& model, const Rings& rings);

// A tube along joints, closed at both ends; bark runs around and along it.
struct Joint {
  V3 at;
  float radius = 0;
};
struct Tube {
  int sides = 6;
  std::uint16_t material = 0, cap_material = 0;
  bool cut_ends = false;  // flat and hard; otherwise drawn out a little
  float v_per_m = 1;      // of the texture
};
void add_tube(Model& model, std::span<const Joint> joints, const Tube& tube);

// Normals of vertices from the triangles around them, weighted by area, from `first_triangle` on; vertices at one place are
// told apart by their number.
void smooth_normals(Model& model, std::size_t first_triangle = 0);

// Scales to the length along x or the height, moves the middle or the foot to the origin, drops triangles without area.
enum class Stand { lies, stands };
void finish(Model& model, float length_m, Stand stand);

// The makers, one a kind; `form` is the name in the table. Models of about unit length, which make() finishes.
Model make_leaf(const MadeOptions& options);
Model make_twig(const MadeOptions& options);
Model make_stone(const MadeOptions& options);
Model make_tuft(const MadeOptions& options);
Model make_needle(const MadeOptions& options);
Model make_mushroom(const MadeOptions& options);
Model make_straw(const MadeOptions& options);
Model make_cone(const MadeOptions& options);

}  // namespace ghosttile::objects::made
