#include "silvavis/shade/surroundings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "silvavis/shade/atmosphere.h"
#include "silvavis/shade/patches.h"

namespace silvavis::shade {

namespace {

constexpr double earth_m = Atmosphere::ground_radius_m;

double smooth(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// Where a ray crosses a box's walls, seen from above: entry and exit; none where the first is beyond the second.
std::array<double, 2> crossing(const silvasim::base::Box& box, const accel::Ray& ray) {
  double from = 0, to = std::numeric_limits<double>::infinity();
  const double origin[2] = {ray.origin.x, ray.origin.y}, least[2] = {box.west, box.south},
               most[2] = {box.east, box.north};
  const double along[2] = {static_cast<double>(ray.direction.x), static_cast<double>(ray.direction.y)};
  for (int axis = 0; axis < 2; ++axis) {
    if (std::abs(along[axis]) < 1e-12) {
      if (origin[axis] < least[axis] || origin[axis] > most[axis]) return {1, 0};
      continue;
    }
    const double a = (least[axis] - origin[axis]) / along[axis], b = (most[axis] - origin[axis]) / along[axis];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return {from, to};
}

}  // namespace

Surroundings::Surroundings(const scene::Ground& ground, const silvasim::base::Box& planted,
                           const std::vector<Rgb>& colours, const std::vector<Rgb>& usual)
    : box_{ground.west, ground.south, ground.east(), ground.north()},
      planted_(planted),
      level_m_(static_cast<double>(ground.pyramid.origin_m)),
      spread_m_(0.5 * std::min(box_.width(), box_.height())),
      usual_(usual) {
  for (const Rgb& colour : usual_) usual_mean_ += colour / static_cast<float>(usual_.size());
  constexpr int count = 4 * parts;
  around_.resize(count + 1);
  most_m_ = level_m_;
  for (int i = 0; i < count; ++i) {
    const int side = i / parts;
    const double t = (i % parts + 0.5) / parts;
    const double x = side == 0   ? box_.west + t * box_.width()
                     : side == 1 ? box_.east
                     : side == 2 ? box_.east - t * box_.width()
                                 : box_.west;
    const double y = side == 0   ? box_.south
                     : side == 1 ? box_.south + t * box_.height()
                     : side == 2 ? box_.north
                                 : box_.north - t * box_.height();
    const auto height = static_cast<float>(scene::ground_at(ground, x, y).height_m);
    const auto at = static_cast<std::size_t>(i);
    around_[at + 1] = {around_[at].colour + colours[at], around_[at].height_m + height - static_cast<float>(level_m_)};
  }
  for (int i = 0; i < ground.columns; ++i)
    most_m_ =
        std::max({most_m_, static_cast<double>(ground.at(i, 0)), static_cast<double>(ground.at(i, ground.rows - 1))});
  for (int j = 0; j < ground.rows; ++j)
    most_m_ = std::max(
        {most_m_, static_cast<double>(ground.at(0, j)), static_cast<double>(ground.at(ground.columns - 1, j))});
}

double Surroundings::outside(double x, double y) const {
  const double dx = std::max({box_.west - x, x - box_.east, 0.0}), dy = std::max({box_.south - y, y - box_.north, 0.0});
  return std::sqrt(dx * dx + dy * dy);
}

// Mean over a stretch of the border around the nearest point, as wide as that is far.
Surroundings::Part Surroundings::mean_near(const silvasim::base::Box& box, double x, double y, double outside_m) const {
  constexpr int count = 4 * parts;
  const double u = (std::clamp(x, box.west, box.east) - box.west) / box.width();
  const double v = (std::clamp(y, box.south, box.north) - box.south) / box.height();
  // Beyond a corner both its sides meet.
  const double to_side[4] = {
      y < box.south ? box.south - y : v * box.height(), x > box.east ? x - box.east : (1 - u) * box.width(),
      y > box.north ? y - box.north : (1 - v) * box.height(), x < box.west ? box.west - x : u * box.width()};
  double along = 0;
  if (x > box.east && (y >= box.south && y <= box.north))
    along = 1 + v;
  else if (x < box.west && (y >= box.south && y <= box.north))
    along = 4 - v;
  else if (y < box.south)
    along = x > box.east ? 1 : x < box.west ? 4 : u;
  else if (y > box.north)
    along = x > box.east ? 2 : x < box.west ? 3 : 3 - u;
  else {
    const auto side = std::min_element(std::begin(to_side), std::end(to_side)) - std::begin(to_side);
    along = side == 0 ? u : side == 1 ? 1 + v : side == 2 ? 3 - u : 4 - v;
  }
  const double middle = along * parts;
  const double half = std::clamp(0.75 + outside_m / std::min(box.width(), box.height()) * parts, 0.75, count / 2.0);
  const auto sum_to = [&](double part) {
    const double turns = std::floor(part / count), in_turn = part - turns * count;
    const auto i = std::min(static_cast<std::size_t>(in_turn), static_cast<std::size_t>(count - 1));
    const auto t = static_cast<float>(in_turn - static_cast<double>(i));
    const auto whole = static_cast<float>(turns);
    const Part &a = around_[i], &b = around_[i + 1], &all = around_.back();
    return Part{a.colour + (b.colour - a.colour) * t + all.colour * whole,
                a.height_m + (b.height_m - a.height_m) * t + all.height_m * whole};
  };
  const Part before = sum_to(middle - half), after = sum_to(middle + half);
  const auto width = static_cast<float>(2 * half);
  return {(after.colour - before.colour) / width, (after.height_m - before.height_m) / width};
}

double Surroundings::height_at(const scene::Ground& ground, double x, double y) const {
  const double away = outside(x, y);
  if (away >= spread_m_) return level_m_;
  const double near = scene::ground_at(ground, x, y).height_m;
  const double mean = level_m_ + static_cast<double>(mean_near(box_, x, y, away).height_m);
  const double even = smooth(away / (0.04 * spread_m_));
  return level_m_ + (near + (mean - near) * even - level_m_) * (1 - smooth(away / spread_m_));
}

bool Surroundings::cross(const scene::Ground& ground, const accel::Ray& ray, double from_m, double to_m,
                         Point& point) const {
  const double rise = static_cast<double>(ray.direction.z);
  const auto above = [&](double t) {
    const V3d at = ray.origin + V3d(ray.direction) * t;
    // From flat land, as the scene is, to the round earth.
    const double dx = at.x - ray.origin.x, dy = at.y - ray.origin.y, drop = (dx * dx + dy * dy) / (2 * earth_m);
    return at.z - height_at(ground, at.x, at.y) + drop * smooth(outside(at.x, at.y) / spread_m_);
  };
  double from = from_m;
  if (ray.origin.z + rise * from > most_m_) {
    if (rise >= 0) return false;
    from = std::max(from, (most_m_ - ray.origin.z) / rise);
  }
  if (!(from < to_m)) return false;
  double gap = above(from), last = from;
  if (gap < 0) {
    if (from <= 0) return false;  // the eye itself is under it
    point.distance_m = from;      // out of the scene into its border's rim
    return true;
  }
  constexpr int most_steps = 400;
  constexpr double steep = 0.6;  // of the land around; where it is steeper a ray may pass a rim that it should meet
  for (int step = 0; step < most_steps && last < to_m; ++step) {
    const double t = std::min(to_m, last + std::max(gap / (steep + std::abs(rise)), spread_m_ / 200));
    const double next = above(t);
    if (next < 0) {
      // Where the line between both crosses, a few times; the end that stays counts half (the Illinois rule).
      double high = last, low = t, over = gap, under = next;
      for (int k = 0; k < 12; ++k) {
        const double middle = high + (low - high) * over / (over - under);
        const double there = above(middle);
        const bool is_over = there >= 0;
        (is_over ? high : low) = middle;
        (is_over ? over : under) = there;
        (is_over ? under : over) *= 0.5;
        if (std::abs(there) < 0.005 + 1e-6 * middle) {
          high = middle;
          break;
        }
      }
      point.distance_m = high;
      return true;
    }
    last = t;
    gap = next;
    if (rise > 0 && ray.origin.z + rise * t > most_m_) return false;
  }
  return false;
}

void Surroundings::show(const scene::Ground& ground, const accel::Ray& ray, Point& point) const {
  point.at = ray.origin + V3d(ray.direction) * point.distance_m;
  point.outside_m = outside(point.at.x, point.at.y);
  const double x = point.at.x, y = point.at.y;
  if (point.outside_m < spread_m_) {
    const double step = std::max(1.0, 0.5 * std::min(ground.cell_x_m, ground.cell_y_m));
    const double east = height_at(ground, x + step, y) - height_at(ground, x - step, y),
                 north = height_at(ground, x, y + step) - height_at(ground, x, y - step);
    point.normal = V3(static_cast<float>(-east / (2 * step)), static_cast<float>(-north / (2 * step)), 1).normalized();
  }
  const float width_m = ray.width_m + ray.spread * static_cast<float>(point.distance_m);
  point.reflectance = colour_at(x, y, -ray.direction, width_m);
}

bool Surroundings::meet(const scene::Ground& ground, const accel::Ray& ray, double most_m, Point& point) const {
  if (empty()) return false;
  const auto [enter, leave] = crossing(box_, ray);
  const bool through = enter <= leave;
  // On the near side of a scene that the eye stands outside of.
  if (through && enter > 0 && cross(ground, ray, 0, std::min(enter, most_m), point)) {
    show(ground, ray, point);
    return true;
  }
  if (std::isfinite(most_m)) return false;
  const double from = through ? leave : 0;
  const silvasim::base::Box wide = silvasim::base::grown(box_, spread_m_);
  const auto [wide_enter, wide_leave] = crossing(wide, ray);
  if (wide_enter <= wide_leave && cross(ground, ray, std::max(from, wide_enter), wide_leave, point)) {
    show(ground, ray, point);
    return true;
  }
  // The round plain, where it comes up to the ray: z = level - r^2 / 2R.
  const double rise = static_cast<double>(ray.direction.z), height = ray.origin.z - level_m_;
  if (rise >= 0 || height <= 0) return false;
  const double level = 1 - rise * rise, under = rise * rise - 2 * height * level / earth_m;
  if (under <= 0) return false;
  const double t = 2 * height / (-rise + std::sqrt(under));
  if (t < from) return false;
  point.distance_m = t;
  show(ground, ray, point);
  return true;
}

}  // namespace silvavis::shade
