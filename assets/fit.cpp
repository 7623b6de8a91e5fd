#include "assets/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "assets/normals.h"
#include "silvasim/base/error.h"

namespace assets {

namespace {

constexpr std::size_t samples = 65536;

double distance(double x, double y) { return std::sqrt(x * x + y * y); }

double area(const Model& model, const std::array<std::uint32_t, 3>& triangle) {
  const V3d a(model.positions[triangle[0]]);
  return 0.5 * (V3d(model.positions[triangle[1]]) - a).cross(V3d(model.positions[triangle[2]]) - a).length();
}

bool is_hole(const Model& model, std::size_t triangle, double b, double c) {
  const Material& material = model.materials[model.triangle_materials[triangle]];
  if (material.alpha_cutoff <= 0 || material.texture == no_texture) return false;
  const Texture& texture = model.textures[static_cast<std::size_t>(material.texture)];
  const auto& [i, j, k] = model.triangles[triangle];
  const double u = (1 - b - c) * model.uvs[i].x + b * model.uvs[j].x + c * model.uvs[k].x;
  const double v = (1 - b - c) * model.uvs[i].y + b * model.uvs[j].y + c * model.uvs[k].y;
  const auto at = [](double t, int size) {
    return static_cast<std::size_t>(std::min(size - 1, static_cast<int>((t - std::floor(t)) * size)));
  };
  const std::size_t texel = at(v, texture.height) * static_cast<std::size_t>(texture.width) + at(u, texture.width);
  return static_cast<float>(texture.rgba[4 * texel + 3]) < material.alpha_cutoff * 255.0f;
}

// Points spread evenly over what is seen of the surface: equal steps of area, and within a triangle the R2 sequence
// (Roberts 2018) folded into it.
std::vector<V3d> spread_points(const Model& model) {
  double total = 0;
  for (const auto& triangle : model.triangles) total += area(model, triangle);
  std::vector<V3d> points, holes;
  points.reserve(samples);
  double passed = 0;
  std::size_t n = 0;
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    passed += area(model, model.triangles[t]);
    for (; n < samples && (static_cast<double>(n) + 0.5) / samples * total < passed; ++n) {
      double b = static_cast<double>(n) * 0.7548776662466927, c = static_cast<double>(n) * 0.5698402909980532;
      b -= std::floor(b);
      c -= std::floor(c);
      if (b + c > 1) {
        b = 1 - b;
        c = 1 - c;
      }
      const auto& [i, j, k] = model.triangles[t];
      const V3d p = V3d(model.positions[i]) * (1 - b - c) + V3d(model.positions[j]) * b + V3d(model.positions[k]) * c;
      (is_hole(model, t, b, c) ? holes : points).push_back(p);
    }
  }
  return points.empty() ? holes : points;
}

double crown_radius(const Model& model, double axis_x, double axis_y) {
  std::vector<double> distances;
  for (const V3d& p : spread_points(model)) distances.push_back(distance(p.x - axis_x, p.y - axis_y));
  if (distances.empty()) return 0;
  const auto at = static_cast<std::ptrdiff_t>(0.98 * static_cast<double>(distances.size() - 1));
  std::nth_element(distances.begin(), distances.begin() + at, distances.end());
  return distances[static_cast<std::size_t>(at)];
}

// Mean and reach of the triangles that reach into [from, to], by their vertices there.
struct Slice {
  double x = 0, y = 0, area = 0;
  double reach = 0;  // from (x, y)
};

Slice slice(const Model& model, double from, double to) {
  Slice s;
  const auto within = [&](const V3& p) { return p.z >= from && p.z <= to; };
  for (const auto& triangle : model.triangles) {
    double x = 0, y = 0;
    int count = 0;
    for (const std::uint32_t corner : triangle) {
      const V3& p = model.positions[corner];
      if (!within(p)) continue;
      x += p.x;
      y += p.y;
      ++count;
    }
    if (count == 0) continue;
    const double weight = area(model, triangle) * count / 3;
    s.x += weight * x / count;
    s.y += weight * y / count;
    s.area += weight;
  }
  if (s.area <= 0) return s;
  s.x /= s.area;
  s.y /= s.area;
  for (const auto& triangle : model.triangles) {
    for (const std::uint32_t corner : triangle) {
      const V3& p = model.positions[corner];
      if (within(p)) s.reach = std::max(s.reach, distance(p.x - s.x, p.y - s.y));
    }
  }
  return s;
}

}  // namespace

Measures measure(const Model& model) {
  Measures m;
  m.triangles = model.triangles.size();
  constexpr float infinity = std::numeric_limits<float>::infinity();
  m.least = V3(infinity, infinity, infinity);
  m.greatest = -m.least;
  for (const V3& p : model.positions) {
    for (int axis = 0; axis < 3; ++axis) {
      m.least[axis] = std::min(m.least[axis], p[axis]);
      m.greatest[axis] = std::max(m.greatest[axis], p[axis]);
    }
  }
  const double whole = static_cast<double>(m.greatest.z) - m.least.z;
  const bool drawn_to_stand = m.least.z <= 0 && m.greatest.z > 0 && -m.least.z <= 0.25 * whole;
  m.foot_z_m = drawn_to_stand ? 0.0 : static_cast<double>(m.least.z);
  m.height_m = m.greatest.z - m.foot_z_m;

  // What stands in the ground belongs to the foot too; a stem may be one long triangle from its root to its tip.
  const double top = m.foot_z_m + 0.02 * m.height_m;
  Slice foot = slice(model, m.least.z, top);
  if (distance(foot.x, foot.y) > foot.reach) {
    m.foot_x_m = foot.x;
    m.foot_y_m = foot.y;
  }
  for (const V3& p : model.positions) {
    const double from_axis = distance(p.x - m.foot_x_m, p.y - m.foot_y_m);
    m.reach_m = std::max(m.reach_m, from_axis);
    if (p.z <= top) m.foot_radius_m = std::max(m.foot_radius_m, from_axis);
  }

  m.crown_radius_m = crown_radius(model, m.foot_x_m, m.foot_y_m);
  return m;
}

Model fitted(Model model, const Size& size, LoadReport* report) {
  const auto fail = [&](const std::string& what) {
    throw silvasim::base::Error("model \"" + model.name + "\" cannot be fitted: " + what);
  };
  if (!(size.height_m > 0 && size.height_m <= 1000)) fail("the height should be above 0 m, at most 1000 m");
  if (!(size.radius_m >= 0 && size.radius_m <= 1000)) fail("the radius should be 0 m to 1000 m");
  const Measures m = measure(model);
  if (!(m.height_m > 1e-9)) fail("it has no height");
  if (!(m.crown_radius_m > 1e-9)) fail("it has no width");
  const double up = size.height_m / m.height_m;
  double out = size.radius_m > 0 ? size.radius_m / m.crown_radius_m : up;
  if (!std::isfinite(up) || !std::isfinite(out)) fail("its measures are no numbers");
  const double stretch = std::max(up / out, out / up);
  if (stretch > 1.5 && report != nullptr) {
    const auto rounded = [](double value) { return std::to_string(std::round(value * 100) / 100).substr(0, 4); };
    report->warnings.push_back("model \"" + model.name + "\" is made " + rounded(stretch) + " times " +
                               (up > out ? "narrower" : "wider") +
                               " for its height than it was drawn; another model would suit the species better");
  }

  // The share of the surface that lies far out changes when a model is stretched, so the radius is found by steps.
  const std::vector<V3> drawn = model.positions;
  for (int step = 0; step < 4; ++step) {
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      const V3& p = drawn[i];
      model.positions[i] =
          V3(static_cast<float>((p.x - m.foot_x_m) * out), static_cast<float>((p.y - m.foot_y_m) * out),
             static_cast<float>((p.z - m.foot_z_m) * up));
    }
    const double reached = crown_radius(model, 0, 0);
    if (size.radius_m == 0 || step == 3 || !(reached > 0) || std::abs(reached / size.radius_m - 1) < 1e-3) break;
    out *= size.radius_m / reached;
  }
  for (V3& n : model.normals) {
    const V3d wide(n.x / out, n.y / out, n.z / up);
    n = V3(wide / wide.length());
  }
  // Rounding may take the area of very thin triangles.
  std::size_t kept = 0;
  for (std::size_t i = 0; i < model.triangles.size(); ++i) {
    const auto& [a, b, c] = model.triangles[i];
    if (!has_area(model.positions[a], model.positions[b], model.positions[c])) continue;
    model.triangles[kept] = model.triangles[i];
    model.triangle_materials[kept++] = model.triangle_materials[i];
  }
  if (kept == 0) fail("its triangles are too thin");
  model.triangles.resize(kept);
  model.triangle_materials.resize(kept);
  face_normals(model);  // of leaf cards, whose normals are not their own
  return model;
}

}  // namespace assets
