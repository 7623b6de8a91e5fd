#include "ghosttile/objects/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "silvasim/base/error.h"

namespace ghosttile::objects {

namespace {

using silvasim::base::Error;

[[noreturn]] void fail(const assets::Model& model, const std::string& what) {
  throw Error(fmt::format("detail \"{}\": {}", model.name, what));
}

void check(const assets::Model& model) {
  if (model.triangles.empty()) fail(model, "has no triangle; a detail needs a surface");
  if (model.triangles.size() > most_triangles) {
    fail(model, fmt::format("has {} triangles; a detail may have {}: simplify it first", model.triangles.size(),
                            most_triangles));
  }
  for (const V3& p : model.positions) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      fail(model, "has a corner whose place is not a finite number");
    if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > 1e6f)
      fail(model, "reaches farther than 1000 km; models are in metres");
  }
  for (const auto& t : model.triangles) {
    for (const std::uint32_t v : t) {
      if (v >= model.positions.size())
        fail(model, fmt::format("has a triangle with corner {}, but only {} corners", v, model.positions.size()));
    }
  }
}

// Vertices at one place get one number.
std::vector<std::uint32_t> welded(const std::vector<V3>& positions) {
  const auto before = [&](std::uint32_t i, std::uint32_t j) {
    const V3 &a = positions[i], &b = positions[j];
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
  };
  std::vector<std::uint32_t> order(positions.size()), place(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), before);
  for (std::size_t k = 0; k < order.size(); ++k)
    place[order[k]] = k > 0 && !before(order[k - 1], order[k]) ? place[order[k - 1]] : order[k];
  return place;
}

std::uint32_t root(std::vector<std::uint32_t>& parents, std::uint32_t i) {
  while (parents[i] != i) i = parents[i] = parents[parents[i]];
  return i;
}

void widen(V3d& least, V3d& most, const V3d& p) {
  least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
  most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
}

struct PartOf {
  bool open = false;
  double volume = 0, area = 0;
  V3d least{0, 0, 0}, most{0, 0, 0}, origin{0, 0, 0};
  bool begun = false;
};

// No thin sheet: area^2 over extent times volume is about 12 for a bar, however thin, and 3 to 4 n for a sheet that is n
// times as wide as thick.
bool encloses(const PartOf& part, double sheets) {
  const double volume = std::abs(part.volume), extent = (part.most - part.least).length();
  return !part.open && volume > 1e-9 * part.area * extent && part.area * part.area < 4 * sheets * extent * volume;
}

void find_columns(Surface& s) {
  s.columns = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(s.corners.size()))), 1, 512);
  const auto cell = [&](double at, double low, double high) {
    const double share = high > low ? (at - low) / (high - low) : 0;
    return std::clamp(static_cast<int>(share * s.columns), 0, s.columns - 1);
  };
  const auto each = [&](auto&& visit) {
    for (std::uint32_t t = 0; t < s.corners.size(); ++t) {
      if (!s.solid[t]) continue;
      const auto& [a, b, c] = s.corners[t];
      const int x0 = cell(std::min({a.x, b.x, c.x}), s.least.x, s.most.x);
      const int x1 = cell(std::max({a.x, b.x, c.x}), s.least.x, s.most.x);
      const int y0 = cell(std::min({a.y, b.y, c.y}), s.least.y, s.most.y);
      const int y1 = cell(std::max({a.y, b.y, c.y}), s.least.y, s.most.y);
      for (int y = y0; y <= y1; ++y) {
        for (int x = x0; x <= x1; ++x) visit(static_cast<std::size_t>(y * s.columns + x), t);
      }
    }
  };
  const auto cells = static_cast<std::size_t>(s.columns) * static_cast<std::size_t>(s.columns);
  s.first.assign(cells + 1, 0);
  each([&](std::size_t c, std::uint32_t) { ++s.first[c + 1]; });
  std::partial_sum(s.first.begin(), s.first.end(), s.first.begin());
  s.members.resize(s.first.back());
  std::vector<std::uint32_t> next(s.first.begin(), s.first.end() - 1);
  each([&](std::size_t c, std::uint32_t t) { s.members[next[c]++] = t; });
}

// A triangle is buried where its middle and its corners, drawn in a little, have volume on their outer side too.
void find_buried(Surface& s) {
  const double off = 1e-5 * s.radius_m;
  for (std::size_t t = 0; t < s.corners.size(); ++t) {
    if (!s.solid[t]) continue;
    const V3d middle = (s.corners[t][0] + s.corners[t][1] + s.corners[t][2]) / 3.0;
    bool all = inside(s, middle + s.normals[t] * off);
    for (int k = 0; all && k < 3; ++k)
      all = inside(s, s.corners[t][static_cast<std::size_t>(k)] * 0.98 + middle * 0.02 + s.normals[t] * off);
    s.buried[t] = all;
  }
}

}  // namespace

Surface surface_of(const assets::Model& model, double sheets) {
  check(model);
  Surface s;
  const std::vector<std::uint32_t> place = welded(model.positions);

  // Join triangles that share corners to parts.
  std::vector<std::uint32_t> parents(model.positions.size());
  std::iota(parents.begin(), parents.end(), 0u);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const auto& t : model.triangles) {
    const V3d a(model.positions[t[0]]), b(model.positions[t[1]]), c(model.positions[t[2]]);
    const V3d normal = (b - a).cross(c - a);
    const double twice = normal.length();
    if (!(twice > 0)) continue;
    triangles.push_back({place[t[0]], place[t[1]], place[t[2]]});
    s.corners.push_back({a, b, c});
    s.normals.push_back(normal / twice);
    s.area_m2.push_back(0.5 * twice);
    s.least = s.corners.size() == 1 ? a : s.least;
    s.most = s.corners.size() == 1 ? a : s.most;
    for (const V3d& p : {a, b, c}) {
      widen(s.least, s.most, p);
    }
    s.middle.push_back((a + b + c) / 3.0);
    s.reach_m.push_back(
        std::max({(a - s.middle.back()).length(), (b - s.middle.back()).length(), (c - s.middle.back()).length()}));
    const std::uint32_t r = root(parents, place[t[0]]);
    parents[root(parents, place[t[1]])] = r;
    parents[root(parents, place[t[2]])] = r;
  }
  if (triangles.empty()) fail(model, "has no area: all its triangles are lines or points");
  s.radius_m = 0.5 * (s.most - s.least).length();

  // A part is open where an edge is not run through as often in one direction as in the other.
  struct Edge {
    std::uint32_t low, high;
    int way;
  };
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (const auto& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      if (a != b) edges.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.way < b.way;
  });
  std::vector<PartOf> parts(model.positions.size());
  for (std::size_t i = 0, j = 0; i < edges.size(); i = j) {
    int sum = 0;
    for (j = i; j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high; ++j)
      sum += edges[j].way;
    if (sum != 0) parts[root(parents, edges[i].low)].open = true;
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    PartOf& part = parts[root(parents, triangles[t][0])];
    const auto& [a, b, c] = s.corners[t];
    if (!part.begun) part.origin = part.least = part.most = a;
    part.begun = true;
    for (const V3d& p : {a, b, c}) widen(part.least, part.most, p);
    part.volume += (a - part.origin).dot((b - part.origin).cross(c - part.origin)) / 6;
    part.area += s.area_m2[t];
  }
  s.solid.resize(triangles.size());
  s.buried.assign(triangles.size(), 0);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const PartOf& part = parts[root(parents, triangles[t][0])];
    s.solid[t] = encloses(part, sheets);
    if (s.solid[t] && part.volume < 0) {
      std::swap(s.corners[t][1], s.corners[t][2]);
      s.normals[t] = -s.normals[t];
    }
  }
  for (const PartOf& part : parts) {
    if (part.begun && encloses(part, sheets)) s.volume_m3 += std::abs(part.volume);
  }
  find_columns(s);
  find_buried(s);
  return s;
}

}  // namespace ghosttile::objects
