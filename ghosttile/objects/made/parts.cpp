#include "ghosttile/objects/made/parts.h"

#include <algorithm>
#include <cmath>

#include "assets/normals.h"

namespace ghosttile::objects::made {

V3 Draws::direction() {
  const float z = around(0, 1), r = std::sqrt(1 - z * z);
  const SinCos a = sin_cos(2 * pi * share());
  return {r * a.cos, r * a.sin, z};
}

float rough(float u, float v, int cells_u, int cells_v, std::uint32_t salt) {
  float sum = 0, weight = 0.55f;
  for (std::uint32_t octave = 0; octave < 3; ++octave) {
    sum += weight * assets::grown::tiling_noise(u * static_cast<float>(cells_u), v * static_cast<float>(cells_v),
                                                cells_u, cells_v, salt + octave);
    cells_u *= 2;
    cells_v *= 2;
    weight *= 0.5f;
  }
  return sum;
}

std::uint16_t add_material(Model& model, const std::string& name, const Rgb& reflectance, int texture) {
  assets::Material material;
  material.name = name;
  material.reflectance = reflectance;
  material.texture = texture;
  model.materials.push_back(material);
  return static_cast<std::uint16_t>(model.materials.size() - 1);
}

int add_texture(Model& model, assets::grown::Canvas canvas, const std::string& name, bool has_alpha) {
  model.textures.push_back(assets::grown::to_texture(std::move(canvas), name, has_alpha));
  return static_cast<int>(model.textures.size()) - 1;
}

void add_rings(Model& model, const Rings& g) {
  const auto count = static_cast<std::uint32_t>(g.rings.size());
  const auto sides = static_cast<std::uint32_t>(g.rings[0].size());

  // Normals by the grid, so that the seam of the texture does not show.
  std::vector<V3> normals(static_cast<std::size_t>(count) * sides, V3(0, 0, 0));
  const auto at = [&](std::uint32_t r, std::uint32_t k) -> const V3& { return g.rings[r][k % sides]; };
  const auto normal = [&](std::uint32_t r, std::uint32_t k) -> V3& { return normals[r * sides + k % sides]; };
  for (std::uint32_t r = 0; r + 1 < count; ++r) {
    for (std::uint32_t k = 0; k < sides; ++k) {
      const V3 n = (at(r + 1, k + 1) - at(r, k)).cross(at(r + 1, k) - at(r, k + 1));
      for (V3* to : {&normal(r, k), &normal(r, k + 1), &normal(r + 1, k), &normal(r + 1, k + 1)}) *to += n;
    }
  }
  const auto fan_normal = [&](std::uint32_t r, const V3& end, float sign) {
    V3 sum(0, 0, 0);
    for (std::uint32_t k = 0; k < sides; ++k) {
      const V3 n = (at(r, k + 1) - at(r, k)).cross(end - at(r, k)) * sign;
      sum += n;
      if (!g.hard_caps) {
        normal(r, k) += n;
        normal(r, k + 1) += n;
      }
    }
    return assets::grown::unit(sum);
  };
  const V3 foot_normal = fan_normal(0, g.foot, -1), tip_normal = fan_normal(count - 1, g.tip, 1);

  const auto put = [&](const V3& p, const V3& n, float u, float v) {
    model.positions.push_back(p);
    model.normals.push_back(assets::grown::unit(n));
    model.uvs.push_back({u, v});
    return static_cast<std::uint32_t>(model.positions.size() - 1);
  };
  const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint16_t material) {
    model.triangles.push_back({a, b, c});
    model.triangle_materials.push_back(material);
  };
  const auto u_of = [&](std::uint32_t k) { return g.u_repeat * static_cast<float>(k) / static_cast<float>(sides); };
  const auto base = static_cast<std::uint32_t>(model.positions.size());
  for (std::uint32_t r = 0; r < count; ++r) {
    for (std::uint32_t k = 0; k <= sides; ++k) put(at(r, k), normal(r, k), u_of(k), g.v[r]);
  }
  const std::uint32_t width = sides + 1;
  for (std::uint32_t r = 0; r + 1 < count; ++r) {
    for (std::uint32_t k = 0; k < sides; ++k) {
      const std::uint32_t a = base + r * width + k, d = a + width;
      triangle(a, a + 1, d + 1, g.material);
      triangle(a, d + 1, d, g.material);
    }
  }
  const auto cap = [&](std::uint32_t r, const V3& end, const V3& n, float v_end, bool tip) {
    std::uint32_t rim = base + r * width;
    if (g.hard_caps) {
      rim = static_cast<std::uint32_t>(model.positions.size());
      for (std::uint32_t k = 0; k <= sides; ++k) put(at(r, k), n, u_of(k), g.v[r]);
    }
    for (std::uint32_t k = 0; k < sides; ++k) {
      const std::uint32_t middle = put(end, n, 0.5f * (u_of(k) + u_of(k + 1)), v_end);
      if (tip) {
        triangle(rim + k, rim + k + 1, middle, g.cap_material);
      } else {
        triangle(middle, rim + k + 1, rim + k, g.cap_material);
      }
    }
  };
  cap(0, g.foot, foot_normal, g.v_foot, false);
  cap(count - 1, g.tip, tip_normal, g.v_tip, true);
}

void add_tube(Model& model, std::span<const Joint> joints, const Tube& tube) {
  Rings g;
  g.material = tube.material;
  g.cap_material = tube.cap_material;
  g.hard_caps = tube.cut_ends;
  V3 side(0, 0, 0);
  float v = 0;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const std::size_t before = i > 0 ? i - 1 : 0, after = std::min(i + 1, joints.size() - 1);
    const V3 along = assets::grown::unit(joints[after].at - joints[before].at);
    side = i == 0 ? assets::grown::across(along) : assets::grown::beside(side, along);
    const V3 other = along.cross(side);
    std::vector<V3> ring;
    for (int k = 0; k < tube.sides; ++k) {
      const SinCos a = sin_cos(2 * pi * static_cast<float>(k) / static_cast<float>(tube.sides));
      ring.push_back(joints[i].at + (side * a.cos + other * a.sin) * joints[i].radius);
    }
    g.rings.push_back(std::move(ring));
    if (i > 0) v += (joints[i].at - joints[before].at).length() * tube.v_per_m;
    g.v.push_back(v);
  }
  const float out = tube.cut_ends ? 0 : 0.7f;
  g.foot = joints.front().at + assets::grown::unit(joints[0].at - joints[1].at) * (out * joints.front().radius);
  const Joint& last = joints.back();
  g.tip = last.at + assets::grown::unit(last.at - joints[joints.size() - 2].at) * (out * last.radius);
  g.v_foot = -joints.front().radius * tube.v_per_m;
  g.v_tip = v + last.radius * tube.v_per_m;
  add_rings(model, g);
}

void smooth_normals(Model& model, std::size_t first_triangle) {
  std::vector<V3> sums(model.positions.size(), V3(0, 0, 0));
  for (std::size_t t = first_triangle; t < model.triangles.size(); ++t) {
    const auto& [a, b, c] = model.triangles[t];
    const V3 n = (model.positions[b] - model.positions[a]).cross(model.positions[c] - model.positions[a]);
    for (const std::uint32_t v : {a, b, c}) sums[v] += n;
  }
  model.normals.resize(model.positions.size(), V3(0, 0, 1));
  for (std::size_t v = 0; v < sums.size(); ++v) {
    if (sums[v].length2() > 0)
      model.normals[v] = assets::grown::unit(
          sums[v] * (1 / std::max({std::abs(sums[v].x), std::abs(sums[v].y), std::abs(sums[v].z)})));
  }
}

void finish(Model& model, float length_m, Stand stand) {
  // Measure what triangles use; nothing else is in a made model.
  V3 least = model.positions[model.triangles[0][0]], most = least;
  for (const auto& t : model.triangles) {
    for (const std::uint32_t v : t) {
      const V3& p = model.positions[v];
      least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
      most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
    }
  }
  const bool lies = stand == Stand::lies;
  const float factor = length_m / (lies ? most.x - least.x : most.z - least.z);
  const V3 origin = lies ? (least + most) * 0.5f : V3(0, 0, least.z);
  for (V3& p : model.positions) p = (p - origin) * factor;
  std::size_t kept = 0;
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    const auto& [a, b, c] = model.triangles[t];
    if (!assets::has_area(model.positions[a], model.positions[b], model.positions[c])) continue;
    model.triangles[kept] = model.triangles[t];
    model.triangle_materials[kept++] = model.triangle_materials[t];
  }
  model.triangles.resize(kept);
  model.triangle_materials.resize(kept);
}

}  // namespace ghosttile::objects::made
