// Random density trees, and their values worked out once more: point by point, in doubles, straight from the nodes.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "ghosttile/density/node.h"

namespace ghosttile::density::test {

// A wavy ground; its bounds by its amplitude.
class Waves final : public Plane {
 public:
  Waves(double middle, double amplitude, double wavelength_m)
      : middle_(middle), amplitude_(amplitude), per_m_(6.283185307 / wavelength_m) {}
  double at(double x, double y) const { return middle_ + amplitude_ * std::sin(x * per_m_) * std::cos(y * per_m_); }
  void sample(const V3d& origin, const float* x, const float* y, std::size_t count, float* value) const override {
    for (std::size_t i = 0; i < count; ++i)
      value[i] = static_cast<float>(at(origin.x + static_cast<double>(x[i]), origin.y + static_cast<double>(y[i])));
  }
  Range bounds(double west, double south, double east, double north) const override {
    const double half_m = 0.5 * std::hypot(east - west, north - south);
    if (!std::isfinite(half_m)) return {float(middle_ - amplitude_ - 1e-4), float(middle_ + amplitude_ + 1e-4)};
    const double here = at(0.5 * (west + east), 0.5 * (south + north)), more = amplitude_ * per_m_ * half_m + 1e-4;
    return {float(std::max(here - more, middle_ - amplitude_ - 1e-4)),
            float(std::min(here + more, middle_ + amplitude_ + 1e-4))};
  }

 private:
  double middle_, amplitude_, per_m_;
};

// One block's worth of points through the compiled field.
inline std::vector<float> values_at(const Compiled& field, const std::vector<V3>& places) {
  std::vector<float> x, y, z, values(places.size());
  for (const V3& p : places) {
    x.push_back(p.x);
    y.push_back(p.y);
    z.push_back(p.z);
  }
  Scratch scratch;
  for (std::size_t i = 0; i < places.size(); i += block_size)
    field.evaluate({x.data() + i, y.data() + i, z.data() + i, std::min(block_size, places.size() - i)}, scratch,
                   values.data() + i);
  return values;
}

inline std::vector<V3> places_in(const Box3& box, const V3d& corner, std::size_t count, std::mt19937& random) {
  std::vector<V3> places(count);
  std::uniform_real_distribution<double> share(0, 1);
  for (V3& p : places)
    for (int k = 0; k < 3; ++k)
      p[k] = static_cast<float>(box.least[k] - corner[k] + share(random) * (box.most[k] - box.least[k]));
  return places;
}

inline V3d nearest_on(const V3d& a, const V3d& b, const V3d& p) {
  const V3d way = b - a;
  const double square = way.dot(way), t = square > 0 ? std::clamp((p - a).dot(way) / square, 0.0, 1.0) : 0;
  return a + way * t;
}

// Distance of a skeleton or solid in doubles, by other formulas than the room's own.
inline double distance_or_rounding(const Node& node, const V3d& p) {
  switch (node.kind) {
    case Kind::point:
      return (p - node.points[0]).length();
    case Kind::sphere:
      return std::max(0.0, (p - node.points[0]).length() - node.size.x);
    case Kind::segment:
    case Kind::curve: {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i + 1 < node.points.size(); ++i)
        least = std::min(least, (p - nearest_on(node.points[i], node.points[i + 1], p)).length());
      return least;
    }
    case Kind::cylinder: {
      // The nearest place of the solid: pulled to the axis' span and to the radius.
      const V3d a = node.points[0], b = node.points[1];
      const double length = (b - a).length();
      const V3d axis = length > 0 ? (b - a) / length : V3d(0, 0, 1);
      const double u = (p - a).dot(axis);
      const V3d off = (p - a) - axis * u;
      V3d nearest = a + axis * std::clamp(u, 0.0, length);
      if (off.length() > 0) nearest += off * std::min(1.0, node.size.x / off.length());
      return (p - nearest).length();
    }
    case Kind::disc: {
      const V3d normal = node.axis / node.axis.length();
      const V3d off = (p - node.points[0]) - normal * (p - node.points[0]).dot(normal);
      V3d nearest = node.points[0];
      if (off.length() > 0) nearest += off * std::min(1.0, node.size.x / off.length());
      return (p - nearest).length();
    }
    case Kind::box: {
      const double turn = node.turn_deg * 3.14159265358979324 / 180;
      const V3d east(std::cos(turn), std::sin(turn), 0), north(-std::sin(turn), std::cos(turn), 0),
          q = p - node.points[0];
      const V3d nearest = east * std::clamp(q.dot(east), -node.size.x, node.size.x) +
                          north * std::clamp(q.dot(north), -node.size.y, node.size.y) +
                          V3d(0, 0, std::clamp(q.z, -node.size.z, node.size.z));
      return (q - nearest).length();
    }
    default: {
      float x = 0, height = 0;
      node.plane->sample(p, &x, &x, 1, &height);
      const double over = p.z - static_cast<double>(height);
      return std::max({0.0, node.from_m - over, over - node.to_m});
    }
  }
}

// Where doubles cannot tell it from 0, it is 0.
inline double distance_of(const Node& node, const V3d& p) {
  const double d = distance_or_rounding(node, p);
  return d < 1e-7 ? 0 : d;
}

// The value at p; not for warps.
inline double value_of(const Node& node, const V3d& p) {
  const auto child = [&](std::size_t i) { return value_of(node.children[i], p); };
  double all = 0;
  switch (node.kind) {
    case Kind::constant:
      return node.value;
    case Kind::above:
    case Kind::column: {
      float x = 0, plane = 0;
      node.plane->sample(p, &x, &x, 1, &plane);
      if (node.kind == Kind::column) return std::max(0.0f, plane);
      return p.z >= static_cast<double>(plane) + node.from_m ? 1 : 0;
    }
    case Kind::blend:
      for (std::size_t i = 0; i < node.children.size(); ++i) all += child(i);
      return std::min(all, 1.0);
    case Kind::unite:
      for (std::size_t i = 0; i < node.children.size(); ++i) all = std::max(all, child(i));
      return all;
    case Kind::intersect:
      all = child(0);
      for (std::size_t i = 1; i < node.children.size(); ++i) all = std::min(all, child(i));
      return all;
    case Kind::differ:
      all = child(0);
      for (std::size_t i = 1; i < node.children.size(); ++i) all = std::max(0.0, std::min(all, 1 - child(i)));
      return all;
    case Kind::multiply:
      all = child(0);
      for (std::size_t i = 1; i < node.children.size(); ++i) all *= child(i);
      return all;
    case Kind::scale:
      return node.value * child(0);
    default: {
      const double d = distance_of(node, p);
      if (d >= node.radius_m) return d <= node.radius_m ? 1 : 0;
      if (d <= node.core * node.radius_m) return 1;
      const double t = (d / node.radius_m - node.core) / (1 - node.core);
      return std::pow(1 - t * t, 3);
    }
  }
}

// Trees within some metres of `middle`.
class Maker {
 public:
  Maker(unsigned seed, const V3d& middle) : random(seed), middle_(middle) {
    for (int i = 0; i < 2; ++i) planes_.push_back(std::make_shared<Waves>(middle.z, 0.4, 7 + i));
    planes_.push_back(std::make_shared<Waves>(0.4, 0.6, 5));  // a response, below 0 and above 1 here and there
  }

  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
  int pick(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random); }
  V3d place(double reach_m = 3) {
    return middle_ + V3d(between(-reach_m, reach_m), between(-reach_m, reach_m), between(-1, 1));
  }

  Node leaf(Kind kind) {
    Node node;
    node.kind = kind;
    node.value = pick(3) == 0 ? pick(2) : between(0, 1.2);
    const int points = kind == Kind::curve ? 2 + pick(5) : kind == Kind::segment || kind == Kind::cylinder ? 2 : 1;
    for (int i = 0; i < points; ++i) node.points.push_back(place());
    node.size = {between(0, 1.2), between(0, 1.2), between(0, 0.6)};
    node.axis = {between(-1, 1), between(-1, 1), between(0.1, 1)};
    node.radius_m = between(0.05, 1.5);
    const bool solid = kind == Kind::box || kind == Kind::cylinder || kind == Kind::sphere || kind == Kind::layer;
    if (solid && pick(3) == 0) node.radius_m = 0;
    if (pick(2)) node.core = between(0, 1);
    if (pick(8) == 0) node.core = 1;
    node.from_m = between(-0.3, 0.2);
    node.to_m = node.from_m + between(0, 0.5);
    node.turn_deg = between(-400, 400);
    if (kind == Kind::layer || kind == Kind::above) node.plane = planes_[std::size_t(pick(2))];
    if (kind == Kind::column) node.plane = planes_[2];
    return node;
  }

  Node tree(int depth, bool warps) {
    if (depth == 0 || pick(6) == 0) return leaf(static_cast<Kind>(pick(11)));
    Node node;
    node.kind = static_cast<Kind>(static_cast<int>(Kind::blend) + pick(warps ? 7 : 6));
    node.value = pick(3) ? between(0, 1.5) : 1;
    node.size.x = pick(4) ? between(0, 0.5) : 0;
    node.radius_m = between(0.2, 2);
    node.seed = random();
    const int children = node.kind == Kind::scale || node.kind == Kind::warp ? 1 : 1 + pick(4);
    for (int i = 0; i < children; ++i) node.children.push_back(tree(depth - 1, warps));
    return node;
  }

  std::mt19937 random;

 private:
  V3d middle_;
  std::vector<std::shared_ptr<const Plane>> planes_;
};

}  // namespace ghosttile::density::test
