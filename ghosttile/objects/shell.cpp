#include "ghosttile/objects/shell.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace ghosttile::objects {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Samples by the nearest centre.
std::vector<std::vector<std::uint32_t>> clusters_of(const std::vector<V3d>& points, const std::vector<V3d>& centres) {
  std::vector<std::vector<std::uint32_t>> clusters(centres.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    std::size_t nearest = 0;
    double least = infinity;
    for (std::size_t k = 0; k < centres.size(); ++k) {
      const double d = (points[i] - centres[k]).length2();
      if (d < least) {
        least = d;
        nearest = k;
      }
    }
    clusters[nearest].push_back(i);
  }
  return clusters;
}

// Adds the farthest sample again and again, until there are `count` or all samples lie within `radius_m`.
void add_farthest(const std::vector<V3d>& points, std::size_t count, double radius_m, std::vector<V3d>& centres) {
  std::vector<double> far(points.size(), infinity);
  const auto take = [&](const V3d& centre) {
    for (std::size_t i = 0; i < points.size(); ++i) far[i] = std::min(far[i], (points[i] - centre).length2());
  };
  for (const V3d& centre : centres) take(centre);
  while (centres.size() < std::min(count, points.size())) {
    const auto next = static_cast<std::size_t>(std::max_element(far.begin(), far.end()) - far.begin());
    if (far[next] <= radius_m * radius_m) break;
    centres.push_back(points[next]);
    take(points[next]);
  }
}

double reach_from(const std::vector<V3d>& points, const std::vector<std::uint32_t>& members, const V3d& from,
                  double enough) {
  double most = 0;
  for (const std::uint32_t i : members) {
    most = std::max(most, (points[i] - from).length2());
    if (most >= enough) break;
  }
  return most;
}

// Moves each centre to that of its own samples from which the others are least far.
void settle(const std::vector<V3d>& points, std::vector<V3d>& centres) {
  for (int round = 0; round < 12; ++round) {
    const auto clusters = clusters_of(points, centres);
    bool moved = false;
    for (std::size_t k = 0; k < centres.size(); ++k) {
      double least = reach_from(points, clusters[k], centres[k], infinity) * (1 - 1e-9);
      const std::size_t step = clusters[k].size() / 512 + 1;
      for (std::size_t i = 0; i < clusters[k].size(); i += step) {
        const double reach = reach_from(points, clusters[k], points[clusters[k][i]], least);
        if (reach < least) {
          least = reach;
          centres[k] = points[clusters[k][i]];
          moved = true;
        }
      }
    }
    if (!moved) break;
  }
}

}  // namespace

Cover cover_of(const Surface& s, const std::vector<V3d>& centres) {
  struct Piece {
    std::array<V3d, 3> corners;
    int depth;
  };
  Cover cover;
  double least = 0;  // some point is as far as that
  std::vector<Piece> open;
  for (std::size_t t = 0; t < s.corners.size(); ++t) {
    if (s.solid[t]) continue;
    open.push_back({s.corners[t], 0});
    while (!open.empty()) {
      const Piece piece = open.back();
      open.pop_back();
      // One ball that holds all corners holds the whole piece.
      double whole = infinity;
      std::array<double, 3> nearest{infinity, infinity, infinity};
      for (const V3d& centre : centres) {
        double farthest = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          const double d = (piece.corners[k] - centre).length2();
          nearest[k] = std::min(nearest[k], d);
          farthest = std::max(farthest, d);
        }
        whole = std::min(whole, farthest);
      }
      for (std::size_t k = 0; k < 3; ++k) {
        if (nearest[k] > least) {
          least = nearest[k];
          cover.farthest = piece.corners[k];
        }
      }
      if (whole <= least * (1.01 * 1.01) || piece.depth >= 24) {
        cover.radius_m = std::max(cover.radius_m, std::sqrt(whole));
        continue;
      }
      // Halve the longest side.
      std::size_t longest = 0;
      double length = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double l = (piece.corners[k] - piece.corners[(k + 1) % 3]).length2();
        if (l > length) {
          length = l;
          longest = k;
        }
      }
      const V3d a = piece.corners[longest], b = piece.corners[(longest + 1) % 3], c = piece.corners[(longest + 2) % 3];
      const V3d middle = (a + b) * 0.5;
      open.push_back({{a, middle, c}, piece.depth + 1});
      open.push_back({{middle, b, c}, piece.depth + 1});
    }
  }
  return cover;
}

std::vector<Ball> cover_shell(const Surface& surface, const Samples& samples, std::size_t count, double radius_m,
                              std::size_t most) {
  const std::vector<V3d>& points = samples.points;
  if (points.empty()) return {};
  // Begin at the sample that is farthest from the middle, so that the first spheres lie at tips.
  V3d mean(0, 0, 0);
  for (const V3d& p : points) mean += p;
  mean /= static_cast<double>(points.size());
  std::size_t first = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if ((points[i] - mean).length2() > (points[first] - mean).length2()) first = i;
  }
  std::vector<V3d> centres{points[first]};
  double radius = radius_m;
  if (radius_m > 0) {
    add_farthest(points, most, 0.97 * radius_m, centres);
    for (Cover cover = cover_of(surface, centres); cover.radius_m > radius_m; cover = cover_of(surface, centres)) {
      if (centres.size() >= most) return {};
      centres.push_back(cover.farthest);
    }
  } else {
    add_farthest(points, count, 0, centres);
    settle(points, centres);
    radius = cover_of(surface, centres).radius_m * (1 + 1e-6);
  }
  std::vector<Ball> balls;
  for (const V3d& centre : centres) balls.push_back({centre, radius});
  return balls;
}

}  // namespace ghosttile::objects
