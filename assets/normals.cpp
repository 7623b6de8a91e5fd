#include "assets/normals.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace assets {

namespace {

V3d doubled_area(const V3& a, const V3& b, const V3& c) {
  const V3d origin(a);
  return (V3d(b) - origin).cross(V3d(c) - origin);
}

}  // namespace

bool has_area(const V3& a, const V3& b, const V3& c) {
  const double longest2 =
      std::max({(V3d(b) - V3d(a)).length2(), (V3d(c) - V3d(b)).length2(), (V3d(a) - V3d(c)).length2()});
  const double area2 = doubled_area(a, b, c).length2();
  return std::isfinite(area2) && longest2 > 1e-30 && area2 > 1e-12 * longest2 * longest2;
}

std::size_t make_normals(Draft& draft) {
  std::vector<V3d> sums;
  const auto missing = [&](std::size_t i) { return draft.normals[i] == V3(0.0f, 0.0f, 0.0f); };

  std::size_t mended = 0;
  bool any_missing = false;
  for (std::size_t i = 0; i < draft.normals.size(); ++i) {
    V3& n = draft.normals[i];
    if (missing(i)) {
      any_missing = true;
      continue;
    }
    const V3d wide(n);
    const double length = wide.length();
    if (std::isfinite(length) && length > 1e-20) {
      n = V3(wide / length);
    } else {
      n = V3(0.0f, 0.0f, 0.0f);
      ++mended;
      any_missing = true;
    }
  }
  if (!any_missing) return mended;

  std::uint32_t groups = 0;
  for (const std::uint32_t group : draft.smooth_with) groups = std::max(groups, group + 1);
  sums.assign(groups, V3d(0.0, 0.0, 0.0));
  for (const auto& [a, b, c] : draft.triangles) {
    const V3d area = doubled_area(draft.positions[a], draft.positions[b], draft.positions[c]);
    for (const std::uint32_t corner : {a, b, c}) sums[draft.smooth_with[corner]] += area;
  }
  // Where areas cancel (a thin leaf given from both sides with shared vertices) any triangle's own side will do.
  const auto direct = [&](std::uint32_t corner, const V3d& fallback) {
    if (!missing(corner)) return;
    V3d sum = sums[draft.smooth_with[corner]];
    if (sum.length() < 1e-6 * fallback.length()) sum = fallback;
    draft.normals[corner] = V3(sum / sum.length());
  };
  for (const auto& [a, b, c] : draft.triangles) {
    const V3d area = doubled_area(draft.positions[a], draft.positions[b], draft.positions[c]);
    for (const std::uint32_t corner : {a, b, c}) direct(corner, area);
  }
  return mended;
}

void face_normals(Model& model) {
  std::map<std::uint32_t, std::uint32_t> turned;  // vertex -> its copy with the other normal
  for (std::size_t i = 0; i < model.triangles.size(); ++i) {
    auto& [a, b, c] = model.triangles[i];
    const V3d area = doubled_area(model.positions[a], model.positions[b], model.positions[c]);
    const V3d normal = V3d(model.normals[a]) + V3d(model.normals[b]) + V3d(model.normals[c]);
    if (area.dot(normal) >= 0) continue;
    if (model.materials[model.triangle_materials[i]].two_sided) {
      std::swap(b, c);
      continue;
    }
    for (std::uint32_t& corner : model.triangles[i]) {
      const auto [it, is_new] = turned.try_emplace(corner, static_cast<std::uint32_t>(model.positions.size()));
      if (is_new) {
        const V3 position = model.positions[corner], flipped = -model.normals[corner];
        const V2 uv = model.uvs[corner];
        model.positions.push_back(position);
        model.normals.push_back(flipped);
        model.uvs.push_back(uv);
      }
      corner = it->second;
    }
  }
}

}  // namespace assets
