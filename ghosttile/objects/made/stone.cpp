// Stones: a sphere cut flat on many sides, the edges worn more or less.
//
// Each point of the sphere moves to where a soft minimum of planes lies: |d . n / h|^p summed over the planes, to the power -1/p.
// Large p leaves edges, small p wears them away.
#include <algorithm>
#include <cmath>
#include <map>

#include "ghosttile/objects/made/parts.h"

namespace ghosttile::objects::made {

namespace {

struct Stone {
  int planes;
  int doublings;  // p = 2^doublings
  V3 size;        // half axes before it is scaled to its length
  float bumps;    // share of the radius
  float vary;     // of the planes' distances
  Rgb colour;
};

Stone stone_of(const std::string& form) {
  if (form == "pebble") return {14, 2, {1, 0.75f, 0.45f}, 0.012f, 0.18f, Rgb(0.27f, 0.25f, 0.23f)};
  if (form == "rock") return {13, 5, {1, 0.8f, 0.62f}, 0.025f, 0.30f, Rgb(0.23f, 0.22f, 0.205f)};
  if (form == "slab") return {12, 5, {1, 0.72f, 0.24f}, 0.02f, 0.22f, Rgb(0.24f, 0.22f, 0.195f)};
  return {16, 3, {1, 0.82f, 0.6f}, 0.03f, 0.25f, Rgb(0.22f, 0.21f, 0.195f)};
}

struct Mesh {
  std::vector<V3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

// 320 triangles: an icosahedron, each of its sides split in four, twice.
Mesh unit_sphere() {
  const float g = 1.6180340f;
  Mesh m{{{-1, g, 0},
          {1, g, 0},
          {-1, -g, 0},
          {1, -g, 0},
          {0, -1, g},
          {0, 1, g},
          {0, -1, -g},
          {0, 1, -g},
          {g, 0, -1},
          {g, 0, 1},
          {-g, 0, -1},
          {-g, 0, 1}},
         {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
          {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
          {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  for (int round = 0; round < 2; ++round) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, fresh] =
          middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<std::uint32_t>(m.points.size()));
      if (fresh) m.points.push_back((m.points[a] + m.points[b]) * 0.5f);
      return at->second;
    };
    std::vector<std::array<std::uint32_t, 3>> old;
    old.swap(m.triangles);
    for (const auto& [a, b, c] : old) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      m.triangles.insert(m.triangles.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
  }
  for (V3& p : m.points) p = assets::grown::unit(p);
  return m;
}

// Speckles of minerals, darker stains, a little lichen.
assets::grown::Canvas paint(const Rgb& colour, std::uint64_t seed) {
  constexpr int size = 128;
  assets::grown::Canvas canvas(size, size);
  const auto salt = static_cast<std::uint32_t>(seed * 613 + 29);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const float u = (static_cast<float>(x) + 0.5f) / size, v = (static_cast<float>(y) + 0.5f) / size;
      const float large = rough(u, v, 3, 3, salt), fine = rough(u, v, 28, 28, salt + 5);
      Rgb c = colour * (1 + 0.32f * large + 0.35f * fine);
      const float warm = 0.12f * rough(u, v, 2, 2, salt + 9);
      c = Rgb(c.x * (1 + warm), c.y, c.z * (1 - warm));
      const float lichen = smooth(0.45f, 0.6f, rough(u, v, 4, 4, salt + 13));
      c = mix(c, Rgb(0.30f, 0.31f, 0.22f), 0.55f * lichen);
      canvas.at(x, y).colour = c;
    }
  }
  return canvas;
}

}  // namespace

Model make_stone(const MadeOptions& options) {
  const Stone stone = stone_of(options.form);
  Draws draws(options.seed, 0);
  std::vector<V3> planes;  // normal over distance
  for (int k = 0; k < stone.planes; ++k) {
    // The planes' normals spread around: of some tries the one farthest from those before.
    V3 best(0, 0, 1);
    float least = 2;
    for (int tries = 0; tries < 6; ++tries) {
      const V3 d = draws.direction();
      float most = -1;
      for (const V3& p : planes) most = std::max(most, assets::grown::unit(p).dot(d));
      if (most < least) {
        least = most;
        best = d;
      }
    }
    planes.push_back(best * (1 / draws.around(1, stone.vary)));
  }
  const auto salt = static_cast<std::uint32_t>(options.seed * 71 + 3);
  Mesh mesh = unit_sphere();
  for (V3& d : mesh.points) {
    float sum = 0;
    for (const V3& plane : planes) {
      float x = std::max(0.0f, plane.dot(d));
      for (int k = 0; k < stone.doublings; ++k) x *= x;
      sum += x;
    }
    float r = assets::grown::power(sum, -1 / static_cast<float>(1 << stone.doublings));
    r = std::min(r, 1.35f);
    const float bump = assets::grown::tiling_noise(3 * d.x + 7, 3 * d.y + 2 * d.z + 7, 64, 64, salt) +
                       0.6f * assets::grown::tiling_noise(5 * d.y + 9, 5 * d.z - 3 * d.x + 15, 64, 64, salt + 1);
    d = d * (r * (1 + stone.bumps * bump));
  }

  // x is the longest axis, z the shortest.
  V3 least(0, 0, 0), most(0, 0, 0);
  for (const V3& p : mesh.points) {
    least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
    most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
  }
  const V3 vary(1, draws.between(0.85f, 1.1f), draws.between(0.8f, 1.15f));
  for (V3& p : mesh.points) p = (p - (least + most) * 0.5f) / (most - least) * stone.size * vary;

  // Soft normals, for edges partly those of the triangles; the texture is laid on from three sides.
  std::vector<V3> soft(mesh.points.size(), V3(0, 0, 0));
  const auto flat = [&](const std::array<std::uint32_t, 3>& t) {
    return (mesh.points[t[1]] - mesh.points[t[0]]).cross(mesh.points[t[2]] - mesh.points[t[0]]);
  };
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t v : t) soft[v] += flat(t);
  }
  Model model;
  const Rgb colour = options.colour.value_or(stone.colour * draws.between(0.75f, 1.25f));
  const int texture = add_texture(model, paint(colour, options.seed), "stone", false);
  const std::uint16_t material = add_material(model, "stone", Rgb(1, 1, 1), texture);
  const float hard = stone.doublings >= 5 ? 0.75f : 0.0f;
  for (const auto& t : mesh.triangles) {
    const V3 n = assets::grown::unit(flat(t) * 100.0f);
    const int axis = std::abs(n.z) >= std::max(std::abs(n.x), std::abs(n.y)) ? 2
                     : std::abs(n.y) > std::abs(n.x)                         ? 1
                                                                             : 0;
    const auto base = static_cast<std::uint32_t>(model.positions.size());
    for (const std::uint32_t v : t) {
      const V3& p = mesh.points[v];
      model.positions.push_back(p);
      model.normals.push_back(assets::grown::unit(mix(assets::grown::unit(soft[v] * 100.0f), n, hard)));
      const V2 uv = axis == 2 ? V2(p.x, p.y) : axis == 1 ? V2(p.x + 0.37f, p.z) : V2(p.y + 0.71f, p.z + 0.3f);
      model.uvs.push_back(uv * 1.3f);
    }
    model.triangles.push_back({base, base + 1, base + 2});
    model.triangle_materials.push_back(material);
  }
  return model;
}

}  // namespace ghosttile::objects::made
