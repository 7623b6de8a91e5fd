#include "ghosttile/objects/sphere_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "ghosttile/objects/medial.h"
#include "ghosttile/objects/shell.h"
#include "silvasim/base/error.h"

namespace ghosttile::objects {

namespace {

constexpr std::uint32_t use_fit = 0, use_error = 1;

// How much a sample at this distance outside of a sphere counts: the square, so that spheres spread evenly.
double cost(const Ball& ball, const V3d& p) {
  const double d = std::max(0.0, (p - ball.centre).length() - ball.radius_m);
  return d * d;
}

// Balls whose centres lie inside, made as large as the triangles allow.
std::vector<Ball> candidates(const Surface& s, const Samples& samples) {
  std::vector<Ball> balls;
  for (Ball ball : medial_balls(samples, s.radius_m)) {
    if (!(ball.radius_m > 1e-4 * s.radius_m) || !inside(s, ball.centre)) continue;
    ball.radius_m = distance_m(s, ball.centre, 1.0001 * ball.radius_m, 1);
    balls.push_back(ball);
  }
  return balls;
}

// The next ball is always the one that takes most off the sum of costs. What a ball takes off only shrinks as others are
// chosen, so only the best of the old figures needs to be worked out anew (Minoux 1978).
std::vector<std::uint32_t> chosen(const std::vector<Ball>& balls, const std::vector<V3d>& points, double radius_m,
                                  double grown, std::size_t count) {
  std::vector<double> left(points.size(), 4 * radius_m * radius_m), bare(points.size(), 2 * radius_m);
  const auto gain = [&](const Ball& ball) {
    double sum = 0;
    for (std::size_t i = 0; i < points.size(); ++i) sum += std::max(0.0, left[i] - cost(ball, points[i]));
    return sum;
  };
  struct Entry {
    double gain;
    std::uint32_t ball;
    std::size_t known;  // when so many were chosen
    bool operator<(const Entry& o) const { return gain != o.gain ? gain < o.gain : ball > o.ball; }
  };
  std::priority_queue<Entry> queue;
  for (std::uint32_t b = 0; b < balls.size(); ++b) queue.push({gain(balls[b]), b, 0});
  std::vector<std::uint32_t> result;
  const double enough = 0.005 * radius_m;
  while (result.size() < count && !queue.empty()) {
    Entry best = queue.top();
    queue.pop();
    if (best.known < result.size()) {
      queue.push({gain(balls[best.ball]), best.ball, result.size()});
      continue;
    }
    result.push_back(best.ball);
    const Ball& taken = balls[best.ball];
    double farthest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      left[i] = std::min(left[i], cost(taken, points[i]));
      bare[i] = std::min(bare[i], (points[i] - taken.centre).length() - taken.radius_m * grown);
      farthest = std::max(farthest, bare[i]);
    }
    if (farthest <= enough) break;  // the surface is covered
  }
  return result;
}

// Each sphere's own samples: those that no other sphere is nearer to.
std::vector<std::vector<std::uint32_t>> own_samples(const std::vector<Ball>& balls, const std::vector<V3d>& points) {
  std::vector<std::vector<std::uint32_t>> own(balls.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < balls.size(); ++k) {
      const double d = (points[i] - balls[k].centre).length() - balls[k].radius_m;
      if (d < least) {
        least = d;
        nearest = k;
      }
    }
    own[nearest].push_back(i);
  }
  return own;
}

// Puts in the place of each sphere the candidate that serves the sphere's own samples best, until nothing changes.
void settle(std::vector<Ball>& set, const std::vector<Ball>& balls, const std::vector<V3d>& points) {
  for (int round = 0; round < 6; ++round) {
    const auto own = own_samples(set, points);
    bool changed = false;
    for (std::size_t k = 0; k < set.size(); ++k) {
      const auto sum_of = [&](const Ball& ball, double enough) {
        double sum = 0;
        for (const std::uint32_t i : own[k]) {
          sum += cost(ball, points[i]);
          if (sum >= enough) break;
        }
        return sum;
      };
      double least = sum_of(set[k], std::numeric_limits<double>::infinity()) * (1 - 1e-9);
      for (const Ball& ball : balls) {
        if ((ball.centre - set[k].centre).length() > set[k].radius_m + ball.radius_m) continue;
        const double sum = sum_of(ball, least);
        if (sum < least) {
          least = sum;
          set[k] = ball;
          changed = true;
        }
      }
    }
    if (!changed) break;
  }
}

std::vector<Ball> fit_solid(const Surface& s, const SphereFitOptions& options, std::size_t count) {
  const double grown = 1 + static_cast<double>(options.outside_share);
  const Samples samples =
      sample(s, Part::solid, std::clamp<std::size_t>(32 * count, 1536, 8192), options.seed, use_fit);
  const std::vector<Ball> balls = candidates(s, samples);
  std::vector<Ball> set;
  for (const std::uint32_t b : chosen(balls, samples.points, s.radius_m, grown, count)) set.push_back(balls[b]);
  if (set.empty()) return set;
  settle(set, balls, samples.points);
  // Each sphere grows as far as its own samples need it, within what it may.
  const auto own = own_samples(set, samples.points);
  for (std::size_t k = 0; k < set.size(); ++k) {
    double need = set[k].radius_m;
    for (const std::uint32_t i : own[k]) need = std::max(need, (samples.points[i] - set[k].centre).length());
    set[k].radius_m = std::min(need, set[k].radius_m * grown);
  }
  return set;
}

std::vector<Ball> fit_shell(const assets::Model& model, const Surface& s, const SphereFitOptions& options,
                            std::size_t count) {
  const double area = area_of(s, Part::shell);
  const auto radius = static_cast<double>(options.thickness_m);
  const double expect = radius > 0 ? std::min(1.0 * most_spheres, area / (2 * radius * radius)) : 0;
  const std::size_t wish = 40 * std::max(count, static_cast<std::size_t>(expect));
  const Samples samples = sample(s, Part::shell, std::clamp<std::size_t>(wish, 2048, 16384), options.seed, use_fit);
  std::vector<Ball> set = cover_shell(s, samples, count, radius, most_spheres);
  if (set.empty()) {
    throw silvasim::base::Error(
        fmt::format("detail \"{}\": spheres of the half thickness {} m would need to be more than {} to hold its "
                    "{:.4g} m2; give a larger thickness",
                    model.name, options.thickness_m, most_spheres, area));
  }
  return set;
}

void check(const assets::Model& model, const SphereFitOptions& o) {
  const auto fail = [&](const std::string& what) {
    throw silvasim::base::Error(fmt::format("detail \"{}\": {}", model.name, what));
  };
  if (o.spheres < 1 || o.spheres > most_spheres)
    fail(fmt::format("{} spheres were asked for; 1 to {} are possible", o.spheres, most_spheres));
  if (!(o.outside_share >= 0 && o.outside_share <= most_outside))
    fail(fmt::format("spheres shall reach outside by {} of their radius; 0 to {} are possible", o.outside_share,
                     most_outside));
  if (!(o.thickness_m >= 0) || !std::isfinite(o.thickness_m))
    fail(fmt::format("the half thickness {} m is not a length", o.thickness_m));
}

}  // namespace

SphereFit fit_spheres(const assets::Model& model, const SphereFitOptions& options) {
  check(model, options);
  Surface s = surface_of(model);
  if (options.all_shell) {
    std::fill(s.solid.begin(), s.solid.end(), std::uint8_t{0});
    std::fill(s.buried.begin(), s.buried.end(), std::uint8_t{0});
  }

  // Share the spheres between solid parts and shells by area.
  const double solid = area_of(s, Part::solid), shell = area_of(s, Part::shell);
  const auto all = static_cast<std::size_t>(options.spheres);
  std::size_t for_shell =
      solid > 0 ? static_cast<std::size_t>(static_cast<double>(all) * shell / (solid + shell) + 0.5) : all;
  if (shell > 0 && solid > 0 && all > 1) for_shell = std::clamp<std::size_t>(for_shell, 1, all - 1);
  std::vector<Ball> set;
  if (for_shell < all) set = fit_solid(s, options, all - for_shell);
  if (set.empty() && solid > 0) {  // too jagged for any ball
    std::fill(s.solid.begin(), s.solid.end(), std::uint8_t{0});
    std::fill(s.buried.begin(), s.buried.end(), std::uint8_t{0});
    for_shell = all;
  }
  if (for_shell > 0 && area_of(s, Part::shell) > 0) {
    const std::vector<Ball> more = fit_shell(model, s, options, for_shell);
    set.insert(set.end(), more.begin(), more.end());
  }
  SphereFit fit;
  for (const Ball& ball : set) {
    fit.spheres.push_back(
        {V3(static_cast<float>(ball.centre.x), static_cast<float>(ball.centre.y), static_cast<float>(ball.centre.z)),
         static_cast<float>(ball.radius_m)});
  }
  fit.error = error_of(model, fit.spheres, options.seed);
  return fit;
}

SphereError error_of(const assets::Model& model, const std::vector<Sphere>& spheres, std::uint64_t seed) {
  const Surface s = surface_of(model);
  SphereError error;
  for (const Sphere& sphere : spheres) {
    const V3d centre(sphere.centre);
    const auto radius = static_cast<double>(sphere.radius_m);
    const double far = distance_m(s, centre, centre.length() + 4 * s.radius_m + s.least.length());
    error.outside_m =
        std::max(error.outside_m, static_cast<float>(std::max(0.0, inside(s, centre) ? radius - far : radius + far)));
  }
  const Samples samples = sample(s, Part::all, 16384, seed, use_error);
  double sum = 0;
  for (const V3d& p : samples.points) {
    double least = std::numeric_limits<double>::infinity();
    for (const Sphere& sphere : spheres)
      least = std::min(least, (p - V3d(sphere.centre)).length() - static_cast<double>(sphere.radius_m));
    sum += std::abs(least);
    error.uncovered_m = std::max(error.uncovered_m, static_cast<float>(least));
  }
  error.mean_m = samples.points.empty() ? 0 : static_cast<float>(sum / static_cast<double>(samples.points.size()));
  return error;
}

}  // namespace ghosttile::objects
