// Bodies whose volume and distance are known, for the tests of sphere sets.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "assets/model.h"

namespace shapes {

using assets::Model;
using assets::V3;

inline void close(Model& m) {
  m.normals.assign(m.positions.size(), V3(0, 0, 1));
  m.uvs.assign(m.positions.size(), assets::V2(0, 0));
  m.triangle_materials.assign(m.triangles.size(), 0);
  m.materials.resize(1);
}

inline Model box(const V3& size) {
  Model m;
  m.name = "box";
  for (int i = 0; i < 8; ++i)
    m.positions.push_back(V3(i & 1 ? 0.5f : -0.5f, i & 2 ? 0.5f : -0.5f, i & 4 ? 0.5f : -0.5f) * size);
  m.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                 {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  close(m);
  return m;
}

inline Model icosphere(float radius, int rounds) {
  Model m;
  m.name = "icosphere";
  const float g = 1.6180340f;
  m.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                 {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  m.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                 {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                 {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int r = 0; r < rounds; ++r) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto key = std::minmax(a, b);
      const auto [at, fresh] = middles.try_emplace(key, static_cast<std::uint32_t>(m.positions.size()));
      if (fresh) m.positions.push_back((m.positions[a] + m.positions[b]) * 0.5f);
      return at->second;
    };
    auto old = std::move(m.triangles);
    m.triangles.clear();
    for (const auto& [a, b, c] : old) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      m.triangles.insert(m.triangles.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
  }
  for (V3& p : m.positions) p = p.normalized() * radius;
  close(m);
  return m;
}

// A flat sheet in x and y, seen from above; no volume.
inline Model sheet(float width, float length, int cells) {
  Model m;
  m.name = "sheet";
  const auto n = static_cast<std::uint32_t>(cells);
  for (std::uint32_t y = 0; y <= n; ++y) {
    for (std::uint32_t x = 0; x <= n; ++x) {
      m.positions.push_back({(static_cast<float>(x) / static_cast<float>(n) - 0.5f) * width,
                             (static_cast<float>(y) / static_cast<float>(n) - 0.5f) * length, 0});
    }
  }
  for (std::uint32_t y = 0; y < n; ++y) {
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t a = y * (n + 1) + x, b = a + n + 1;
      m.triangles.push_back({a, a + 1, b + 1});
      m.triangles.push_back({a, b + 1, b});
    }
  }
  close(m);
  return m;
}

inline Model joined(Model a, const Model& b, const V3& shift) {
  const auto base = static_cast<std::uint32_t>(a.positions.size());
  for (const V3& p : b.positions) a.positions.push_back(p + shift);
  for (const auto& t : b.triangles) a.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  close(a);
  return a;
}

}  // namespace shapes
