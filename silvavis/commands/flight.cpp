#include "silvavis/commands/flight.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>

#include "silvasim/base/error.h"

namespace silvavis::commands {

namespace {

constexpr double radians = std::numbers::pi / 180;
constexpr double most_samples = 200000, least_step_m = 0.05;
constexpr double smoothing_s = 2;

// Between two values with these slopes, at t in [0, 1] of a span of length h (cubic Hermite).
template <class T>
T hermite(const T& a, const T& b, const T& slope_a, const T& slope_b, double h, double t) {
  const double u = 1 - t;
  return a * ((1 + 2 * t) * u * u) + slope_a * (h * t * u * u) + b * (t * t * (3 - 2 * t)) - slope_b * (h * t * t * u);
}

// The slope at the middle of three values, of the parabola through them; h and k are the spans before and after.
template <class T>
T middle_slope(const T& a, const T& b, const T& c, double h, double k) {
  return ((b - a) * (k / h) + (c - b) * (h / k)) / (h + k);
}

// Index i with at[i] <= x < at[i + 1], within the last span.
template <class Range, class Project>
std::size_t span_of(const Range& at, double x, Project project) {
  const auto next = std::upper_bound(at.begin() + 1, at.end() - 1, x,
                                     [&](double value, const auto& item) { return value < project(item); });
  return static_cast<std::size_t>(next - at.begin()) - 1;
}

// Means over the values within `reach` along `at`, twice.
void smooth(std::vector<double>& values, const std::vector<double>& at, double reach) {
  std::vector<double> sums(values.size() + 1);
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t i = 0; i < values.size(); ++i) sums[i + 1] = sums[i] + values[i];
    std::size_t first = 0, end = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      while (at[first] < at[i] - reach) ++first;
      while (end < values.size() && at[end] <= at[i] + reach) ++end;
      values[i] = (sums[end] - sums[first]) / static_cast<double>(end - first);
    }
  }
}

// A smooth curve that is nowhere below the values: each mean is over greatest values of windows that hold its place.
std::vector<double> smooth_cover(const std::vector<double>& values, const std::vector<double>& at, double reach) {
  std::vector<double> cover(values.size());
  std::deque<std::size_t> greatest;  // candidates, descending
  std::size_t end = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (; end < values.size() && at[end] <= at[i] + 2 * reach; ++end) {
      while (!greatest.empty() && values[greatest.back()] <= values[end]) greatest.pop_back();
      greatest.push_back(end);
    }
    while (at[greatest.front()] < at[i] - 2 * reach) greatest.pop_front();
    cover[i] = values[greatest.front()];
  }
  smooth(cover, at, reach);
  return cover;
}

// (heading, pitch) of a direction, in degrees.
V3d angles_of(const V3d& direction) {
  const double level = std::hypot(direction.x, direction.y);
  return {std::atan2(direction.x, direction.y) / radians, std::atan2(direction.z, level) / radians, 0};
}

V3d direction_of(const V3d& angles) {
  const double pitch = std::clamp(angles.y, -89.99, 89.99) * radians, heading = angles.x * radians;
  return {std::sin(heading) * std::cos(pitch), std::cos(heading) * std::cos(pitch), std::sin(pitch)};
}

}  // namespace

Flight::Flight(const FlightPath& path, const scene::Ground& ground, const FlightOptions& options)
    : ground_(ground), options_(options) {
  std::vector<std::size_t> sample_of_point;
  trace(path, sample_of_point);
  const auto above = [](const PathPoint& point) { return point.above_ground; };
  keep_off_the_ground(std::all_of(path.points.begin(), path.points.end(), above));

  length_.assign(way_.size(), 0);
  for (std::size_t i = 1; i < way_.size(); ++i) length_[i] = length_[i - 1] + (way_[i] - way_[i - 1]).length();
  for (const std::size_t sample : sample_of_point) keys_.push_back({0, length_[sample]});
  set_times(path);
  const double frames = std::floor(duration_s_ * options_.fps + 1e-6) + 1;
  if (!(frames <= most_frames)) {
    throw silvasim::base::ConfigError(
        {"command line", 0, 0},
        fmt::format("the flight of {:.6g} s has {:.6g} frames; at most {} are made", duration_s_, frames, most_frames));
  }
  frames_ = static_cast<int>(frames);
  set_looks(path);
}

// Lays the curve through the points, as many short steps. Where heights count from the ground, z is that height.
void Flight::trace(const FlightPath& path, std::vector<std::size_t>& sample_of_point) {
  const bool follow =
      std::all_of(path.points.begin(), path.points.end(), [](const PathPoint& point) { return point.above_ground; });
  std::vector<V3d> at;
  std::vector<std::size_t> place_of_point;
  for (const PathPoint& point : path.points) {
    const V3d here(point.eye.x, point.eye.y, follow ? point.height_m : point.eye.z);
    if (at.empty() || (at.back() - here).length() > 1e-6) at.push_back(here);
    place_of_point.push_back(at.size() - 1);
  }
  closed_ = at.size() > 3 && (at.front() - at.back()).length() < 1e-6;
  double around = 0;
  std::vector<double> span;  // of the curve's parameter: the root of the distance
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    const double distance = (at[i + 1] - at[i]).length();
    around += distance;
    span.push_back(std::sqrt(distance));
  }
  std::vector<V3d> slope(at.size());
  const std::size_t last = at.size() - 1;
  for (std::size_t i = 1; i < last; ++i) slope[i] = middle_slope(at[i - 1], at[i], at[i + 1], span[i - 1], span[i]);
  if (closed_) {
    slope[0] = slope[last] = middle_slope(at[last - 1], at[0], at[1], span[last - 1], span[0]);
  } else if (last > 0) {
    slope[0] = (at[1] - at[0]) / span[0];
    slope[last] = (at[last] - at[last - 1]) / span[last - 1];
  }
  const double step = std::max(around / most_samples, least_step_m);
  std::vector<std::size_t> sample_of_place{0};
  way_.push_back(at[0]);
  for (std::size_t i = 0; i < last; ++i) {
    const int steps = std::max(4, static_cast<int>(span[i] * span[i] / step));
    for (int k = 1; k < steps; ++k)
      way_.push_back(hermite(at[i], at[i + 1], slope[i], slope[i + 1], span[i], static_cast<double>(k) / steps));
    way_.push_back(at[i + 1]);
    sample_of_place.push_back(way_.size() - 1);
  }
  if (last == 0) way_.push_back(at[0]);  // it stays in one place
  for (const std::size_t place : place_of_point) sample_of_point.push_back(sample_of_place[place]);

  // How long it takes tells how far a second is.
  const double timed = path.points.back().time_s ? *path.points.back().time_s - *path.points.front().time_s : 0;
  duration_s_ = timed > 0             ? timed
                : options_.duration_s ? *options_.duration_s
                : path.duration_s     ? *path.duration_s
                                      : around / options_.speed_m_s;
}

void Flight::keep_off_the_ground(bool all_above_ground) {
  std::vector<double> level(way_.size()), ground(way_.size()), lift(way_.size());
  for (std::size_t i = 0; i < way_.size(); ++i) {
    if (i > 0) level[i] = level[i - 1] + std::hypot(way_[i].x - way_[i - 1].x, way_[i].y - way_[i - 1].y);
    ground[i] = scene::ground_at(ground_, way_[i].x, way_[i].y).height_m;
  }
  const double reach = std::clamp(smoothing_s / 2 * level.back() / duration_s_, 3.0, 200.0);
  if (all_above_ground) {
    const std::vector<double> cover = smooth_cover(ground, level, reach);
    for (std::size_t i = 0; i < way_.size(); ++i) way_[i].z += cover[i];
  }
  for (std::size_t i = 0; i < way_.size(); ++i) lift[i] = std::max(0.0, ground[i] + options_.clearance_m - way_[i].z);
  lift = smooth_cover(lift, level, reach);
  for (std::size_t i = 0; i < way_.size(); ++i) way_[i].z += lift[i];
}

void Flight::set_times(const FlightPath& path) {
  const bool timed = path.points.front().time_s.has_value();
  if (!timed && !options_.duration_s && !path.duration_s) duration_s_ = length_m() / options_.speed_m_s;
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    keys_[i].time_s =
        timed ? *path.points[i].time_s - *path.points.front().time_s : duration_s_ * keys_[i].length_m / length_m();
  }
  // Slopes that never overshoot: the harmonic mean of the spans' own.
  std::vector<double> speed;
  for (std::size_t i = 0; i + 1 < keys_.size(); ++i)
    speed.push_back((keys_[i + 1].length_m - keys_[i].length_m) / (keys_[i + 1].time_s - keys_[i].time_s));
  slope_.assign(keys_.size(), 0);
  slope_.front() = speed.front();
  slope_.back() = speed.back();
  for (std::size_t i = 1; i + 1 < keys_.size(); ++i) {
    if (speed[i - 1] > 0 && speed[i] > 0) slope_[i] = 2 / (1 / speed[i - 1] + 1 / speed[i]);
  }
}

void Flight::set_looks(const FlightPath& path) {
  const auto& points = path.points;
  const auto has_place = [](const PathPoint& point) { return point.look_at.has_value(); };
  const auto says_nothing = [](const PathPoint& point) { return !point.look_at && !point.heading_deg; };
  if (std::all_of(points.begin(), points.end(), says_nothing)) return;
  looks_are_points_ = std::all_of(points.begin(), points.end(), has_place);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PathPoint& point = points[i];
    if (looks_are_points_) {
      looks_.push_back(*point.look_at);
      continue;
    }
    V3d angles = point.look_at       ? angles_of(*point.look_at - eye_at(keys_[i].length_m))
                 : point.heading_deg ? V3d(*point.heading_deg, point.pitch_deg, 0)
                                     : angles_of(look_ahead(keys_[i].length_m));
    // Turn the shorter way.
    if (!looks_.empty()) angles.x += 360 * std::round((looks_.back().x - angles.x) / 360);
    looks_.push_back(angles);
  }
}

double Flight::length_at(double time_s) const {
  const double time = std::clamp(time_s, 0.0, duration_s_);
  const std::size_t i = span_of(keys_, time, [](const Key& key) { return key.time_s; });
  const double h = keys_[i + 1].time_s - keys_[i].time_s;
  const double t = std::clamp((time - keys_[i].time_s) / h, 0.0, 1.0);
  return std::clamp(hermite(keys_[i].length_m, keys_[i + 1].length_m, slope_[i], slope_[i + 1], h, t), 0.0, length_m());
}

V3d Flight::eye_at(double length_m) const {
  double at = length_m;
  const double all = length_.back();
  if (closed_ && at > all) at = std::fmod(at, all);
  const std::size_t i = span_of(length_, std::clamp(at, 0.0, all), [](double length) { return length; });
  const double h = length_[i + 1] - length_[i];
  // Beyond the end the last step goes on.
  const double t = h > 0 ? (at - length_[i]) / h : 0;
  V3d eye = way_[i] + (way_[i + 1] - way_[i]) * t;
  if (at <= all) eye.z = std::max(eye.z, scene::ground_at(ground_, eye.x, eye.y).height_m + options_.clearance_m);
  return eye;
}

V3d Flight::look_ahead(double length_m) const {
  const double far_m = std::clamp(smoothing_s * length_.back() / duration_s_, 10.0, 200.0);
  const V3d ahead = eye_at(length_m + far_m) - eye_at(length_m);
  V3d angles = angles_of(ahead);
  angles.y -= options_.look_down_deg;
  return direction_of(angles);
}

Flight::View Flight::at(double time_s) const {
  constexpr double arm_m = 100;
  View view;
  const double length = length_at(time_s);
  view.eye = eye_at(length);
  if (!looks_.empty()) {
    const double time = std::clamp(time_s, 0.0, duration_s_);
    const std::size_t i = span_of(keys_, time, [](const Key& key) { return key.time_s; });
    const auto span = [&](std::size_t k) { return keys_[k + 1].time_s - keys_[k].time_s; };
    const auto slope = [&](std::size_t k) {
      if (k == 0) return V3d((looks_[1] - looks_[0]) / span(0));
      if (k + 1 == looks_.size()) return V3d((looks_[k] - looks_[k - 1]) / span(k - 1));
      return middle_slope(looks_[k - 1], looks_[k], looks_[k + 1], span(k - 1), span(k));
    };
    const double t = std::clamp((time - keys_[i].time_s) / span(i), 0.0, 1.0);
    const V3d look = hermite(looks_[i], looks_[i + 1], slope(i), slope(i + 1), span(i), t);
    view.look_at = looks_are_points_ ? look : view.eye + direction_of(look) * arm_m;
    if ((view.look_at - view.eye).length() > 1e-3) return view;
  }
  view.look_at = view.eye + look_ahead(length) * arm_m;
  return view;
}

Flight::View Flight::frame(int number) const { return at((number - 1) / options_.fps); }

}  // namespace silvavis::commands
